// What culling takes on a device that is a CPU when nothing holds it up: short work, nearly all of one thread, so the
// shortest of its newest times.
#pragma once

#include <array>
#include <cstddef>

#include "control/depth_map_choice.h"

namespace eye {

class ShortestPass {
 public:
  // Of a frame that culled with `size`; returns the shortest of the newest times with it, trials' among them: a size
  // that is judged by few times looks dearer than one that is judged by many.
  double observe(DepthMapChoice size, double passMs);

 private:
  struct Newest {
    std::array<double, 16> ms{};
    size_t count = 0;
  };
  std::array<Newest, kDepthMapSizes> bySize_;
};

}  // namespace eye
