// The poses that a host has told of the last second, and what was between them. Owner thread: render.
#pragma once

#include <optional>
#include <vector>

#include "link/track.h"

namespace eye {

class PoseHistory {
 public:
  // In any order; of two of the same time the one that is added last counts.
  void add(double atS, const Pose& pose);
  void clear() { samples_.clear(); }
  bool empty() const { return samples_.empty(); }
  const TrackSample& newest() const { return samples_.back(); }

  // As a recording's (link/track.h): smooth, along the ground, and the short way round. Before the oldest pose that
  // one; a jump is one at the later pose's time. Nothing beyond the newest, and where the next ones are too far apart.
  std::optional<Pose> at(double atS) const;

 private:
  std::vector<TrackSample> samples_;  // by time, each greater than the one before
};

}  // namespace eye
