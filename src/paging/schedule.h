// What is to be loaded before it is missed: one plan an interval, worked off evenly. Owner thread: render.
#pragma once

#include <algorithm>
#include <functional>

#include "paging/interval.h"
#include "paging/region.h"

namespace eye {

// The viewpoint to come, as the frame knows it.
struct LookAhead {
  double nowS = 0;          // a clock that never goes back
  double frameRateHz = 60;  // about
  double speedMS = 0;
  bool jumped = false;  // the viewpoint is somewhere else than predicted: what was planned is of no use
  RegionOptions region;
  std::function<ViewpointAhead(double inS)> at;  // up to kFarthestAheadS
};
inline constexpr double kFarthestAheadS = 15;

class Schedule {
 public:
  // A new plan when the interval is over, when what the last one asked for is there, or after a jump. `roomBytes`: what
  // decoded groups may still take up in memory; `coarsening`: the tolerances of `ahead` are taken times this.
  void update(TerrainCache& cache, const LookAhead& ahead, double coarsening, const PagingRates& rates,
              uint64_t roomBytes);
  // What the plan asks for, soonest first: in the memory area to be on the GPU, behind it in the cache area to be
  // decoded.
  std::span<const GroupAhead> wanted() const { return plan_.wanted; }
  bool isInMemoryArea(const GroupAhead& group) const { return group.neededInS <= memoryS_; }
  double plannedAtS() const { return plannedAtS_; }
  uint32_t plan() const { return number_; }  // 0: none yet
  const Interval& interval() const { return interval_; }
  double memoryS() const { return memoryS_; }
  double cacheS() const { return cacheS_; }

  // Of the groups that the memory area waits for, how many may go to the GPU in this frame so that the interval's are
  // spread over its frames.
  int uploadsDue();
  void uploaded(int groups) { credit_ = std::max(credit_ - groups, 0.0); }

 private:
  bool isDue(const LookAhead& ahead, const TerrainCache& cache) const;

  RegionPlan plan_;
  std::vector<ViewpointAhead> path_;
  uint32_t number_ = 0;
  Interval interval_{0.1, true};
  double plannedAtS_ = 0, memoryS_ = 0, cacheS_ = 0;
  double creditPerFrame_ = 0, credit_ = 0;
};

}  // namespace eye
