// Which triangle each pixel shows: an identity buffer drawn in software, to count the triangles that a picture needs.
#pragma once

#include <span>
#include <vector>

#include "geo/view.h"

namespace eye {

class TriangleIds {
 public:
  explicit TriangleIds(const View& view);  // of the view's size in pixels
  // Corners relative to the eye, ecef. Triangles that face away are left out; what reaches behind the near plane is
  // clipped. True where it covers some pixel's centre, hidden or not.
  bool draw(const Vec3d& a, const Vec3d& b, const Vec3d& c, uint32_t id);
  // Those that show at least one pixel's centre, each once, ascending; and how many they are.
  std::vector<uint32_t> visibleIds() const;
  size_t visible() const { return visibleIds().size(); }
  std::span<const double> inverseZ() const { return inverseZ_; }  // by pixel, 1/m of the nearest; 0: sky
  size_t pixelsShown() const;                                     // that are not sky

 private:
  View view_;
  std::vector<double> inverseZ_;  // of the nearest, 1/m; 0: sky
  std::vector<uint32_t> ids_;
};

}  // namespace eye
