#include "link/sender.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <queue>
#include <thread>

#include "link/cigi_host.h"
#include "link/native_fdm.h"
#include "telemetry/trace.h"

namespace eye {
namespace {

constexpr double kNsPerS = 1e9;
constexpr int64_t kNever = std::numeric_limits<int64_t>::max();
constexpr int64_t kSecondNs = 1'000'000'000;
constexpr int64_t kStopCheckNs = 50'000'000;  // the longest sleep: how long an interrupt may take

int64_t nsOf(double seconds) {
  return static_cast<int64_t>(std::llround(seconds * kNsPerS));
}

struct Departure {
  int64_t atNs = 0;
  uint64_t order = 0;  // ties leave in the order in which they came
  std::vector<std::byte> payload;
  bool operator>(const Departure& other) const { return atNs != other.atNs ? atNs > other.atNs : order > other.order; }
};
using Departures = std::priority_queue<Departure, std::vector<Departure>, std::greater<>>;

void sleepUntil(int64_t deadlineNs) {
  const int64_t leftNs = deadlineNs - monotonicNs();
  if (leftNs <= 0) return;
  std::this_thread::sleep_until(std::chrono::steady_clock::now() +
                                std::chrono::nanoseconds(std::min(leftNs, kStopCheckNs)));
}

void sendOne(const Departure& departure, const UdpSocket& socket, SendReport& report) {
  const SendOutcome outcome = socket.send(departure.payload);
  report.nobodyListens = outcome == SendOutcome::refused;
  if (outcome == SendOutcome::failed) {
    ++report.failed;
    return;
  }
  ++report.datagrams;
  if (const auto state = parseNativeFdm(departure.payload))
    report.pose = state->pose;
  else if (const auto pose = cigi::entityPoseIn(departure.payload))
    report.pose = pose;
}

// The small sum keeps a last packet that falls on the end from being lost to rounding.
uint64_t packetsIn(double durationS, double rateHz) {
  return static_cast<uint64_t>(durationS * rateHz + 1e-6) + 1;
}

}  // namespace

PacketSource cigiPacketsFromPoses(std::function<Pose(double timeS)> poseAt, double durationS, double rateHz,
                                  cigi::Version version, std::function<uint32_t()> igFrame, const cigi::AskPlan& plan) {
  const uint64_t count = packetsIn(durationS, rateHz);
  return {count, static_cast<double>(count) / rateHz,
          [poseAt = std::move(poseAt), igFrame = std::move(igFrame), rateHz, version, plan,
           number = std::make_shared<uint32_t>(0)](uint64_t index) {
            const double timeS = static_cast<double>(index) / rateHz;
            const uint32_t frame = (*number)++;
            return RecordedPacket{timeS, cigi::hostMessage(version, {frame, igFrame(), frame / rateHz, poseAt(timeS),
                                                                     cigi::requestsAt(plan, frame)})};
          }};
}

PacketSource packetsFromPoses(std::function<Pose(double timeS)> poseAt, double durationS, double rateHz) {
  const uint64_t count = packetsIn(durationS, rateHz);
  return {count, static_cast<double>(count) / rateHz, [poseAt = std::move(poseAt), rateHz](uint64_t index) {
            const double timeS = static_cast<double>(index) / rateHz;
            return RecordedPacket{timeS, buildNativeFdm({poseAt(timeS), std::nullopt})};
          }};
}

PacketSource packetsFromRecording(std::vector<RecordedPacket> packets) {
  EYE_CHECK(!packets.empty());
  const uint64_t count = packets.size();
  const double lastS = packets.back().timeS;
  // The next round begins one mean step after the last packet; a second for a recording that has no step.
  const double stepS = lastS > 0 ? lastS / static_cast<double>(count - 1) : 1.0;
  return {count, lastS + stepS, [packets = std::move(packets)](uint64_t index) { return packets[index]; }};
}

SendReport sendPackets(const PacketSource& source, const UdpSocket& socket, const SendOptions& options,
                       const std::atomic<bool>& stop, const std::function<void(const SendReport&)>& everySecond) {
  BadLink link(options.badLink);
  const int64_t periodNs = nsOf(source.roundS / static_cast<double>(source.count));
  const int64_t endNs = options.durationS ? nsOf(*options.durationS) : kNever;
  Departures departures;
  SendReport report;
  uint64_t round = 0, index = 0, order = 0;
  int64_t nextSecondNs = kSecondNs;
  const int64_t startNs = monotonicNs();

  RecordedPacket next = source.packetAt(0);
  int64_t nextNs = 0;  // when `next` is due; all times count from startNs
  while (!stop) {
    const int64_t departureNs = departures.empty() ? kNever : departures.top().atNs;
    const int64_t eventNs = std::min({nextNs, departureNs, endNs});
    if (eventNs == kNever) break;  // all sent
    int64_t nowNs = monotonicNs() - startNs;
    if (nowNs < eventNs) {
      sleepUntil(startNs + std::min(eventNs, nextSecondNs));
      nowNs = monotonicNs() - startNs;
    }
    report.elapsedS = static_cast<double>(nowNs) / kNsPerS;
    if (nowNs >= nextSecondNs) {
      everySecond(report);
      nextSecondNs = (nowNs / kSecondNs + 1) * kSecondNs;
    }
    if (nowNs < eventNs) continue;
    if (eventNs == endNs) break;

    if (departureNs <= nextNs) {
      sendOne(departures.top(), socket, report);
      departures.pop();
      continue;
    }
    ++report.packets;
    const auto times = link.departures(nextNs, periodNs);
    report.lost += times.empty() ? 1u : 0u;
    report.duplicated += times.size() > 1 ? 1u : 0u;
    for (const int64_t atNs : times) departures.push({atNs, order++, next.payload});
    if (++index == source.count) index = 0, ++round;
    const bool more = round == 0 || options.loop;
    if (more) next = source.packetAt(index);
    nextNs = more ? nsOf(static_cast<double>(round) * source.roundS + next.timeS) : kNever;
  }
  report.elapsedS = static_cast<double>(monotonicNs() - startNs) / kNsPerS;
  return report;
}

SendReport sendOnDemand(const DemandedSource& source, const UdpSocket& socket, const SendOptions& options,
                        const std::atomic<bool>& stop, const std::function<void(const SendReport&)>& everySecond) {
  BadLink link(options.badLink);
  constexpr int64_t kPeriodNs = kSecondNs / 60;  // by which a reordered packet is late
  const int64_t endNs = options.durationS ? nsOf(*options.durationS) : kNever;
  Departures departures;
  SendReport report;
  uint64_t order = 0;
  int64_t nextSecondNs = kSecondNs, sentNs = -nsOf(source.patienceS);  // the first packet waits for nothing
  const int64_t startNs = monotonicNs();
  const int64_t leastNs = nsOf(source.leastS), patienceNs = nsOf(source.patienceS);
  bool more = true, isOwed = false;  // owed: demanded, too early
  while (!stop && (more || !departures.empty())) {
    int64_t nowNs = monotonicNs() - startNs;
    report.elapsedS = static_cast<double>(nowNs) / kNsPerS;
    if (nowNs >= endNs) break;
    if (nowNs >= nextSecondNs) {
      everySecond(report);
      nextSecondNs = (nowNs / kSecondNs + 1) * kSecondNs;
    }
    while (!departures.empty() && departures.top().atNs <= nowNs) {
      sendOne(departures.top(), socket, report);
      departures.pop();
    }
    const int64_t untilNs = std::min({nextSecondNs, endNs, nowNs + kStopCheckNs, isOwed ? sentNs + leastNs : kNever,
                                      departures.empty() ? kNever : departures.top().atNs});
    constexpr int64_t kNsPerMs = 1'000'000;
    if (isOwed)
      sleepUntil(startNs + untilNs);
    else
      isOwed = source.awaitDemand(static_cast<int>((untilNs - nowNs + kNsPerMs - 1) / kNsPerMs)) && more;
    nowNs = monotonicNs() - startNs;
    if (!more || nowNs - sentNs < (isOwed ? leastNs : patienceNs)) continue;
    auto payload = source.packetAt(static_cast<double>(nowNs) / kNsPerS, isOwed);
    isOwed = false;
    more = payload.has_value();
    if (!more) continue;
    sentNs = nowNs;
    ++report.packets;
    const auto times = link.departures(nowNs, kPeriodNs);
    report.lost += times.empty() ? 1u : 0u;
    report.duplicated += times.size() > 1 ? 1u : 0u;
    for (const int64_t atNs : times) departures.push({atNs, order++, *payload});
  }
  report.elapsedS = static_cast<double>(monotonicNs() - startNs) / kNsPerS;
  return report;
}

}  // namespace eye
