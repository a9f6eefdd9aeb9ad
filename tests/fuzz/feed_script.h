// Several datagrams in one input, for the fuzzers of protocols that know what came before: steps of
//   u8  milliseconds since the last step, above 200 seconds instead (201: 1 s)
//   u8  who sends: 0 the host, 1 another one, 2 the host from another port, ... (modulo 4)
//   u16 bytes of the datagram, little-endian; what the input lacks is missing
// and the datagram. What a feed makes of them is looked at after each.
#pragma once

#include <cmath>
#include <vector>

#include "base/byte_reader.h"
#include "link/live_feed.h"
#include "link/pose_limits.h"

namespace eye::fuzz {

struct Step {
  uint8_t wait = 16, sender = 0;
  std::span<const std::byte> datagram;
};

inline constexpr size_t kMaxSteps = 64;

inline std::vector<Step> stepsOf(std::span<const std::byte> input) {
  std::vector<Step> steps;
  ByteReader reader(input, std::endian::little);
  while (reader.remaining() >= 4 && steps.size() < kMaxSteps) {
    Step step{reader.u8(), reader.u8(), {}};
    const size_t bytes = reader.u16();
    step.datagram = reader.bytes(std::min(bytes, reader.remaining()));
    steps.push_back(step);
  }
  return steps;
}

inline void addStep(std::vector<std::byte>& input, std::span<const std::byte> datagram, uint8_t wait = 16,
                    uint8_t sender = 0) {
  const auto bytes = static_cast<uint16_t>(datagram.size());
  for (const int part : {int{wait}, int{sender}, bytes & 0xff, bytes >> 8}) input.push_back(std::byte(part));
  input.insert(input.end(), datagram.begin(), datagram.end());
}

inline void checkPose(const Pose& pose) {
  const Geodetic& at = pose.position;
  EYE_CHECK(std::abs(at.latDeg) <= 90 && std::abs(at.lonDeg) <= 180);
  EYE_CHECK(at.altM >= kMinAltitudeM && at.altM <= kMaxAltitudeM);
  EYE_CHECK(std::isfinite(pose.headingDeg) && std::abs(pose.pitchDeg) <= 90 && std::abs(pose.rollDeg) <= 180);
}

// What a frame of that moment gets is fit to be drawn, whatever has been said.
inline void checkSample(const SourceSample& sample, int64_t nowNs) {
  EYE_CHECK(sample.heard.size() <= kMaxHeard);
  EYE_CHECK(sample.atNs <= sample.arrivedNs && sample.arrivedNs <= nowNs);
  for (size_t i = 0; i < sample.heard.size(); ++i) {
    checkPose(sample.heard[i].pose);
    EYE_CHECK(i == 0 || sample.heard[i].atNs >= sample.heard[i - 1].atNs);
  }
  if (sample.julianDayUtc) EYE_CHECK(std::isfinite(*sample.julianDayUtc));
  if (sample.visibilityM) EYE_CHECK(*sample.visibilityM >= kMinVisibilityM && *sample.visibilityM <= kMaxVisibilityM);
  const Frustum frustum = frustumWith({-1, 1, -1, 1, 1}, sample.edges);
  EYE_CHECK(frustum.tanLeft < frustum.tanRight && frustum.tanBottom < frustum.tanTop && frustum.nearM > 0);
  if (!sample.valid) return;
  checkPose(sample.pose);
  if (!sample.motion) return;
  for (const int64_t atNs : {sample.atNs - 500'000'000, nowNs, sample.atNs + sample.carryOnNs})
    checkPose(sample.motion(atNs));
}

// `args`: the receiver's.
template <class Receiver, class... Args>
void feed(std::span<const std::byte> input, int64_t silenceNs, Args&&... args) {
  spdlog::set_level(spdlog::level::off);
  LiveFeed<Receiver> feed("fuzz", HostLock({}, silenceNs), std::forward<Args>(args)...);
  int64_t nowNs = 1'000'000'000'000;
  HostCounts counts;
  for (const Step& step : stepsOf(input)) {
    nowNs += step.wait > 200 ? (step.wait - 200) * 1'000'000'000LL : step.wait * 1'000'000LL;
    ++counts.packets;
    if (!feed.take(step.datagram, {0x7f000001, static_cast<uint16_t>(1000 + step.sender % 4)}, nowNs))
      ++counts.rejected;
    if (step.sender >= 0x80) continue;  // some come between the same two frames
    feed.publish(counts, nowNs);
    (void)feed.due(nowNs);
    checkSample(feed.sample(nowNs + 5'000'000), nowNs + 5'000'000);
    if (const auto reply = feed.frameDone({}, nowNs)) EYE_CHECK(reply->datagram.size() <= kMaxDatagramBytes);
  }
}

}  // namespace eye::fuzz
