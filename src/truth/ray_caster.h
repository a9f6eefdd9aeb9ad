// The truth that pictures are measured against: rays cast in double precision on the bilinear source over WGS84. Shares
// no code with the program. Exact to 1 mm along the ray: a march that skips under a pyramid of greatest heights, a
// quadratic in each cell that it cannot skip, the root polished on the exact surface.
#pragma once

#include <vector>

#include "truth/height_grid.h"
#include "truth/wgs84.h"

namespace eye::truth {

enum class HitKind : unsigned char {
  terrain,  // on the source, or on the sea far outside it
  sky,
  unknown,  // at a void of the source or in the fringe around it, where a bake fades to sea level
};

struct Hit {
  HitKind kind = HitKind::sky;
  double distanceM = 0;  // of terrain
};

// The eye must be over the grid, and the grid's borders further than a ray may curve back over them.
Hit castRay(const HeightGrid& grid, Vec eyeEcefM, Vec directionEcef);

// One hit a pixel, and one row and column more on each side than the picture, so that every pixel has eight neighbours.
struct TruthImage {
  int widthPx = 0, heightPx = 0;
  std::vector<Hit> hits;                      // (widthPx + 2) x (heightPx + 2), row 0 above the picture's top
  const Hit& at(int row, int column) const {  // -1 to heightPx, -1 to widthPx
    return hits[static_cast<size_t>(row + 1) * static_cast<size_t>(widthPx + 2) + static_cast<size_t>(column + 1)];
  }
};

// `fovDeg`: the full horizontal angle; pixels are square; rays go through the pixels' centres.
TruthImage castImage(const HeightGrid& grid, const EyePose& pose, double fovDeg, int widthPx, int heightPx);

}  // namespace eye::truth
