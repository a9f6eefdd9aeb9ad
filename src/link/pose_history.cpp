#include "link/pose_history.h"

#include <algorithm>

#include "geo/frames.h"

namespace eye {
namespace {

constexpr double kKeptS = 1;
constexpr size_t kMostSamples = 256;  // a host of 250 Hz; beyond it the oldest go sooner
// Farther apart nobody knows what was between, and a curve through it would be invented.
constexpr double kLongestGapS = 0.5;
constexpr double kFastestMS = 10'000;  // faster is a jump: an orbit has 7,800 m/s

bool isJump(const TrackSample& from, const TrackSample& to) {
  return glm::distance(ecefFromGeodetic(from.pose.position), ecefFromGeodetic(to.pose.position)) >
         kFastestMS * (to.timeS - from.timeS);
}

}  // namespace

void PoseHistory::add(double atS, const Pose& pose) {
  const auto place = std::ranges::lower_bound(samples_, atS, {}, &TrackSample::timeS);
  if (place != samples_.end() && place->timeS == atS)
    place->pose = pose;
  else
    samples_.insert(place, {atS, pose});
  const double oldestS = samples_.back().timeS - kKeptS;
  const auto kept = std::ranges::lower_bound(samples_, oldestS, {}, &TrackSample::timeS);
  const auto tooMany = samples_.end() - static_cast<std::ptrdiff_t>(std::min(samples_.size(), kMostSamples));
  samples_.erase(samples_.begin(), std::max(kept, tooMany));
}

std::optional<Pose> PoseHistory::at(double atS) const {
  if (samples_.empty() || atS > samples_.back().timeS) return std::nullopt;
  const auto after = std::ranges::lower_bound(samples_, atS, {}, &TrackSample::timeS);
  if (after == samples_.begin() || after->timeS == atS) return after->pose;
  const auto before = after - 1;
  if (after->timeS - before->timeS > kLongestGapS) return std::nullopt;
  if (isJump(*before, *after)) return before->pose;

  // With a neighbour on either side, which say how the curve runs through the two.
  std::vector<TrackSample> four;
  if (before != samples_.begin() && !isJump(*(before - 1), *before)) four.push_back(*(before - 1));
  four.push_back(*before);
  four.push_back(*after);
  if (after + 1 != samples_.end() && !isJump(*after, *(after + 1))) four.push_back(*(after + 1));
  const double fromS = four.front().timeS;
  return Track(std::move(four)).at(atS - fromS);
}

}  // namespace eye
