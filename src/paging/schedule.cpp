#include "paging/schedule.h"

#include <algorithm>
#include <cmath>

namespace eye {
namespace {

// A plan in force is worked off in its interval, and must hold until the next one has been worked off: two intervals.
// Reading, decoding and uploading take the rest.
constexpr double kLatencyS = 1;
constexpr double kCacheOverMemory = 2;  // the cache area reaches this much farther ahead
constexpr double kStepS = 0.5;          // between viewpoints of the path; more where it is long
// While terrain comes in, its children cannot be planned before it is there.
constexpr double kShortestS = 0.1;

}  // namespace

bool Schedule::isDue(const LookAhead& ahead, const TerrainCache& cache) const {
  if (number_ == 0 || ahead.jumped) return true;
  const double sinceS = ahead.nowS - plannedAtS_;
  if (sinceS >= interval_.lengthS) return true;
  if (sinceS < kShortestS || plan_.wanted.empty()) return false;
  // Half of the plan is in: below it there may be more to want.
  const auto isThere = [&](const GroupAhead& group) {
    const std::optional<uint32_t> node = cache.find(group.parent);
    return !node || !cache.children(*node).empty();
  };
  return std::ranges::count_if(plan_.wanted, isThere) * 2 >= static_cast<std::ptrdiff_t>(plan_.wanted.size());
}

void Schedule::update(TerrainCache& cache, const LookAhead& ahead, double coarsening, const PagingRates& rates,
                      uint64_t roomBytes) {
  if (!isDue(ahead, cache)) return;
  interval_ = chooseInterval(ahead.speedMS, plan_.finestWidthM, rates, roomBytes);
  memoryS_ = 2 * interval_.lengthS + kLatencyS;
  cacheS_ = std::min(kCacheOverMemory * memoryS_, kFarthestAheadS);
  const auto steps =
      static_cast<size_t>(std::clamp(std::ceil(cacheS_ / kStepS), 1.0, static_cast<double>(kMostViewpointsAhead - 1)));
  path_.clear();
  for (size_t i = 0; i <= steps; ++i)
    path_.push_back(ahead.at(cacheS_ * static_cast<double>(i) / static_cast<double>(steps)));
  RegionOptions region = ahead.region;
  region.ssePx *= coarsening;
  region.texelPx *= coarsening;
  planRegion(cache, path_, region, ahead.nowS, ++number_, plan_);
  plannedAtS_ = ahead.nowS;
  const auto inMemory = static_cast<double>(
      std::ranges::count_if(plan_.wanted, [this](const GroupAhead& group) { return isInMemoryArea(group); }));
  creditPerFrame_ = inMemory / std::max(interval_.lengthS * ahead.frameRateHz, 1.0);
}

int Schedule::uploadsDue() {
  constexpr double kMostSaved = 2;  // of what earlier frames left over
  credit_ = std::min(credit_, kMostSaved) + creditPerFrame_;
  return static_cast<int>(credit_);
}

}  // namespace eye
