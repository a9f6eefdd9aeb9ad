#include "link/link_thread.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>

#include "telemetry/trace.h"

namespace eye {
namespace {

constexpr int kLinkPollMs = 20;  // how long stopping may take; an idle link wakes up fifty times a second
// Of a flood, waking up for each datagram would be the greater part of the cost: it is let gather in the socket's
// buffer. One batch is read of what has gathered, 32,000 datagrams a second at the most, which no sane host comes near;
// the system drops what does not fit behind it. Reading all would take an eighth of a core from the frame.
constexpr int64_t kGatherNs = 2'000'000;
// A reader that was kept from running makes up for so much of what it has missed, as deep as the buffer is.
constexpr int64_t kMostBehindNs = 40'000'000;
constexpr int64_t kComplaintEveryNs =
    10'000'000'000;  // a wrong host sends 60 bad packets a second: one line of log in ten

}  // namespace

LinkThread::LinkThread(const UdpSocket& socket, LinkProtocol& protocol, std::string name)
    : socket_(socket),
      protocol_(protocol),
      name_(std::move(name)),
      gate_(socket, protocol.shapes(), name_),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

void LinkThread::stop() {
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
}

void LinkThread::run(const std::stop_token& stop) {
  nameThread("link");
  while (!stop.stop_requested()) {
    const size_t taken = flood_.isOn() || socket_.wait(kLinkPollMs) ? drain() : 0;
    const int64_t nowNs = monotonicNs();
    gate_.update(protocol_.soleSender(nowNs), nowNs);
    counts_.unread = gate_.unread();
    protocol_.publish(counts_, nowNs);
    if (const auto outgoing = protocol_.due(nowNs)) (void)socket_.sendTo(outgoing->datagram, outgoing->receiver);
    flood_.count(static_cast<int64_t>(taken), nowNs);
    gather(taken, nowNs);
  }
}

// Waits, in a flood, until the next batch is due. Dates, not waits, have the distance: waits end late.
void LinkThread::gather(size_t taken, int64_t nowNs) {
  const bool isBehind = flood_.isOn() && taken == kBatchDatagrams;
  const int64_t dueNs = isBehind ? std::max(gatheredNs_ + kGatherNs, nowNs - kMostBehindNs) : nowNs + kGatherNs;
  gatheredNs_ = flood_.isOn() ? dueNs : nowNs;
  if (gatheredNs_ > nowNs) std::this_thread::sleep_for(std::chrono::nanoseconds(gatheredNs_ - nowNs));
}

// One batch: after each the mailbox is filled again, so that a flood does not keep the frame from the newest state.
size_t LinkThread::drain() {
  const TraceScope scope("link");
  const std::span<const Datagram> datagrams = batch_.receive(socket_);
  const int64_t nowNs = monotonicNs();
  const std::optional<Peer> sole = protocol_.soleSender(nowNs);
  for (const Datagram& datagram : datagrams) {
    ++counts_.packets;
    const auto taken = protocol_.take(datagram.payload, datagram.sender, nowNs);
    if (taken) continue;
    reject(taken.error(), nowNs);
    if (sole && datagram.sender != *sole)
      gate_.refusedStranger(datagram.sender);
    else
      gate_.refused(datagram.payload, datagram.sender);
  }
  return datagrams.size();
}

void LinkThread::reject(const Error& reason, int64_t nowNs) {
  ++counts_.rejected;
  if (nowNs < nextComplaintNs_) return;
  nextComplaintNs_ = nowNs + kComplaintEveryNs;
  spdlog::warn("{}: packet rejected ({} of {} so far): {}", name_, counts_.rejected, counts_.packets, reason.message);
}

}  // namespace eye
