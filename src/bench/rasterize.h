// A triangle's pixels, in double precision: for judging what the renderer draws, not for drawing.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "geo/view.h"

namespace eye {

struct Projected {
  double x, y, inverseZ;  // pixels, pixels, 1/m
};

// `eyeM`: in the eye's frame, in front of the eye.
inline Projected project(const View& view, const Vec3d& eyeM) {
  const double pixelsPerTan = view.widthPx / (view.frustum.tanRight - view.frustum.tanLeft);
  return {(eyeM.x / eyeM.z - view.frustum.tanLeft) * pixelsPerTan,
          (eyeM.y / eyeM.z + view.frustum.tanTop) * pixelsPerTan, 1.0 / eyeM.z};
}

// Calls pixel(index, 1/z) for every pixel whose centre lies in the triangle, edges included. Corners in the eye's
// frame, in front of the eye.
template <class Pixel>
void rasterize(const View& view, const std::array<Vec3d, 3>& corners, Pixel&& pixel) {
  std::array<Projected, 3> p;
  for (size_t i = 0; i < 3; ++i) p[i] = project(view, corners[i]);
  const double area = (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[1].y - p[0].y) * (p[2].x - p[0].x);
  if (area == 0) return;
  const auto first = [](double low) { return static_cast<int>(std::clamp(std::ceil(low - 0.5), 0.0, 1e6)); };
  const auto last = [](double high, int size) {
    return static_cast<int>(std::clamp(std::floor(high - 0.5), -1.0, size - 1.0));
  };
  const int x0 = first(std::min({p[0].x, p[1].x, p[2].x})), x1 = last(std::max({p[0].x, p[1].x, p[2].x}), view.widthPx);
  const int y0 = first(std::min({p[0].y, p[1].y, p[2].y})),
            y1 = last(std::max({p[0].y, p[1].y, p[2].y}), view.heightPx);
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      const double dx = x + 0.5 - p[0].x, dy = y + 0.5 - p[0].y;
      const double u = (dx * (p[2].y - p[0].y) - dy * (p[2].x - p[0].x)) / area;
      const double v = (dy * (p[1].x - p[0].x) - dx * (p[1].y - p[0].y)) / area;
      if (u < 0 || v < 0 || u + v > 1) continue;
      // 1/z is linear on the screen.
      const double inverseZ = p[0].inverseZ + u * (p[1].inverseZ - p[0].inverseZ) + v * (p[2].inverseZ - p[0].inverseZ);
      pixel(static_cast<size_t>(y) * static_cast<size_t>(view.widthPx) + static_cast<size_t>(x), inverseZ);
    }
  }
}

}  // namespace eye
