#include "link/link_thread.h"

#include <spdlog/spdlog.h>

#include "telemetry/trace.h"

namespace eye {
namespace {

constexpr int kLinkPollMs = 20;  // how long stopping may take; an idle link wakes up fifty times a second
// Datagrams before the mailbox is filled again: a flood must not keep the frame from the newest state.
constexpr int kMaxDatagramsAtOnce = 64;
constexpr int64_t kComplaintEveryNs =
    10'000'000'000;  // a wrong host sends 60 bad packets a second: one line of log in ten

}  // namespace

LinkThread::LinkThread(const UdpSocket& socket, LinkProtocol& protocol, std::string name)
    : socket_(socket),
      protocol_(protocol),
      name_(std::move(name)),
      buffer_(kMaxDatagramBytes),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

void LinkThread::run(const std::stop_token& stop) {
  nameThread("link");
  while (!stop.stop_requested()) {
    if (socket_.wait(kLinkPollMs)) drain();
    protocol_.publish(counts_, monotonicNs());
  }
}

void LinkThread::drain() {
  const TraceScope scope("link");
  for (int i = 0; i < kMaxDatagramsAtOnce; ++i) {
    Peer sender;
    const auto datagram = socket_.receiveFrom(buffer_, sender);
    if (!datagram) break;
    const int64_t nowNs = monotonicNs();
    ++counts_.packets;
    const auto taken = protocol_.take(*datagram, sender, nowNs);
    if (!taken) reject(taken.error(), nowNs);
  }
}

void LinkThread::reject(const Error& reason, int64_t nowNs) {
  ++counts_.rejected;
  if (nowNs < nextComplaintNs_) return;
  nextComplaintNs_ = nowNs + kComplaintEveryNs;
  spdlog::warn("{}: packet rejected ({} of {} so far): {}", name_, counts_.rejected, counts_.packets, reason.message);
}

}  // namespace eye
