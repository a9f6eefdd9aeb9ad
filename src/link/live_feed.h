// From datagrams to what a frame sees, the same for every live protocol: who is heard, when it was true, what is new.
// Without socket and thread. take(), publish() and due() belong to the link thread, sample(), await() and frameDone()
// to the render thread.
#pragma once

#include <spdlog/spdlog.h>

#include <algorithm>

#include "link/host_lock.h"
#include "link/receiver.h"

namespace eye {

template <class Receiver>
class LiveFeed final : public LinkProtocol {
 public:
  // `name`: of the link in log messages; `args`: the receiver's.
  template <class... Args>
  LiveFeed(std::string name, HostLock lock, Args&&... args)
      : name_(std::move(name)), lock_(std::move(lock)), receiver_(std::forward<Args>(args)...) {}

  Result<void> take(std::span<const std::byte> datagram, const Peer& sender, int64_t nowNs) override {
    if (!lock_.isAllowed(sender)) return lock_.refusal(sender);
    if (!Receiver::kManySenders && !lock_.mayPass(sender, nowNs)) return lock_.refusal(sender);
    const auto message = receiver_.parse(datagram);
    if (!message) return tl::unexpected(message.error());
    if (!receiver_.concerns(*message, nowNs)) return {};
    if (!lock_.mayPass(sender, nowNs)) return lock_.refusal(sender);
    if (lock_.heard(sender, nowNs)) {
      receiver_.reset();
      spdlog::info("{}: host {} {}", name_, toText(sender), receiver_.greeting(*message));
    }
    const Taken taken = receiver_.take(*message, sender, nowNs);
    if (taken.moment) {
      moment_ = *taken.moment;
      arrivedNs_ = nowNs;
      isTold_ = false;
      // Closer together they show nothing that the frame could, and a flood would make one of each datagram.
      if (heard_.empty() || moment_.atNs - heard_.back().atNs >= kLeastApartNs) hear(receiver_.state());
    }
    if (!taken.complaint.empty()) return fail(ErrorKind::badData, taken.complaint);
    return {};
  }

  void publish(const HostCounts& counts, int64_t) override {
    HostCounts all = counts;
    all.lost = receiver_.lost();
    if (!isTold_) {
      latest_ = Latest{receiver_.state(), moment_, arrivedNs_};
      if (heard_.empty() || heard_.back().atNs != moment_.atNs) hear(latest_->state);
      isTold_ = true;
    }
    mailbox_.put(latest_, heard_, all);
    heard_.clear();
  }

  std::optional<Peer> soleSender(int64_t nowNs) const override {
    return Receiver::kManySenders ? std::nullopt : lock_.speaker(nowNs);
  }
  std::span<const DatagramShape> shapes() const override { return Receiver::shapes(); }
  std::optional<Outgoing> due(int64_t nowNs) override { return receiver_.due(nowNs); }
  std::optional<Outgoing> farewell(int64_t nowNs) { return receiver_.farewell(nowNs); }
  std::optional<Outgoing> frameDone(const FrameReport& report, int64_t nowNs) {
    return receiver_.frameDone(report, nowNs);
  }
  bool await(int timeoutMs) { return mailbox_.await(timeoutMs); }

  // Not valid before the first state, and while the host says of no place.
  SourceSample sample(int64_t nowNs) {
    auto newest = mailbox_.take();
    SourceSample sample;
    sample.live = true;
    sample.counts = newest.counts;
    if (!newest.state) return sample;
    const State& state = newest.state->state;
    sample.heard = std::move(newest.heard);
    sample.arrivedNs = newest.state->arrivedNs;
    sample.atNs = newest.state->moment.atNs;
    sample.stampedByHost = newest.state->moment.byHost;
    sample.carryOnNs = Receiver::kCarryOnNs;
    const auto pose = Receiver::poseAt(state, std::min(nowNs, sample.atNs + sample.carryOnNs));
    sample.valid = pose.has_value();
    sample.pose = pose.value_or(Pose{});
    if (pose && Receiver::moves(state))
      sample.motion = [state, told = *pose](int64_t atNs) { return Receiver::poseAt(state, atNs).value_or(told); };
    Receiver::tell(state, nowNs, sample);
    return sample;
  }

 private:
  static constexpr int64_t kLeastApartNs = 1'000'000;

  using State = typename Receiver::State;
  struct Latest {
    State state;
    Moment moment;
    int64_t arrivedNs = 0;
  };

  void hear(const State& state) {
    if (const auto pose = Receiver::poseAt(state, moment_.atNs)) heard_.push_back({*pose, moment_.atNs, arrivedNs_});
  }

  const std::string name_;
  // The link thread's.
  HostLock lock_;
  Receiver receiver_;
  Moment moment_;  // of the receiver's state
  int64_t arrivedNs_ = 0;
  bool isTold_ = true;
  std::vector<StampedPose> heard_;  // since the last publish(), which is after 64 datagrams at most
  std::optional<Latest> latest_;

  Mailbox<Latest> mailbox_;
};

}  // namespace eye
