// The depth pyramid on the CPU, for devices that are one: the same texels as depth_map.comp and depth_reduce.comp make,
// at a twentieth of what lavapipe takes for them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "shared/cull_types.h"

namespace eye {

// Places of the pyramid's levels: halved, rounding up, to a single texel.
struct PyramidLayout {
  int levels = 0;
  std::array<int32_t, EYE_MAX_DEPTH_LEVELS> offset{};
  size_t texels = 0;
};
PyramidLayout pyramidLayout(glm::ivec2 mapPx);

class DepthPyramid {
 public:
  // `depth`: the picture's, row 0 on top. `pyramid`: at least layout.texels.
  void build(std::span<const float> depth, glm::ivec2 picturePx, glm::ivec2 mapPx, std::span<float> pyramid);

 private:
  // Kept from frame to frame so that it does not allocate.
  std::vector<float> farthestInRows_;
  std::vector<glm::ivec2> columns_;
};

}  // namespace eye
