// What culling takes on a device that is a CPU when nothing holds it up: short work of one thread, so the shortest of
// its newest times at one size.
#pragma once

#include <array>
#include <cstddef>

#include "control/depth_map_choice.h"

namespace eye {

class ShortestPass {
 public:
  // Of a frame that culled with `size`, or of one without, 0; returns the shortest of the newest times at that choice.
  double observe(DepthMapChoice size, double passMs);

 private:
  std::array<double, 16> newestMs_{};
  size_t count_ = 0;  // observed at size_
  DepthMapChoice size_ = DepthMapChoice::off;
};

}  // namespace eye
