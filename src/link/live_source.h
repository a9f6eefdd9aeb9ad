// A live host: a socket, the thread that reads it, and the feed of the host's protocol.
#pragma once

#include "link/live_feed.h"
#include "telemetry/trace.h"

namespace eye {

template <class Receiver>
class LiveSource final : public StateSource {
 public:
  template <class... Args>
  LiveSource(UdpSocket socket, const std::string& url, HostLock lock, Args&&... args)
      : socket_(std::move(socket)),
        feed_(url, std::move(lock), std::forward<Args>(args)...),
        thread_(socket_, feed_, url) {}
  ~LiveSource() override {
    thread_.stop();  // first: what says goodbye asks for nothing afterwards
    send(feed_.farewell(monotonicNs()));
  }
  LiveSource(const LiveSource&) = delete;
  LiveSource& operator=(const LiveSource&) = delete;

  // Sends from another socket than the one that hears. Before the first frame.
  void speakFrom(UdpSocket socket) { speaks_ = std::move(socket); }

  SourceSample sample(double) override {
    SourceSample sample = feed_.sample(monotonicNs());
    shownHostFrame_ = sample.hostFrame;
    return sample;
  }
  bool await(int timeoutMs) override { return feed_.await(timeoutMs); }
  void frameDone(const FrameReport& report) override {
    FrameReport withFrame = report;
    withFrame.shownHostFrame = shownHostFrame_;
    send(feed_.frameDone(withFrame, monotonicNs()));
  }
  bool isLive() const override { return true; }
  bool isFixed() const override { return false; }

 private:
  void send(const std::optional<Outgoing>& outgoing) {  // what the network does not take is dropped
    if (outgoing) (void)(speaks_ ? *speaks_ : socket_).sendTo(outgoing->datagram, outgoing->receiver);
  }

  UdpSocket socket_;
  std::optional<UdpSocket> speaks_;
  std::optional<uint32_t> shownHostFrame_;  // by the last sample
  LiveFeed<Receiver> feed_;
  LinkThread thread_;  // last: it uses the others
};

}  // namespace eye
