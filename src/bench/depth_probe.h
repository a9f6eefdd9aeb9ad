// A depth map drawn in software, and what it hides: the reference for what occlusion culling could save at best.
#pragma once

#include <vector>

#include "geo/view.h"
#include "terrain/chunk.h"

namespace eye {

enum class BoxVerdict { visible, outside, occluded };

class DepthProbe {
 public:
  explicit DepthProbe(const View& view);  // of the view's size in pixels
  // Corners relative to the eye, ecef. Triangles that reach behind the near plane are left out: they would only hide
  // more.
  void draw(const Vec3d& a, const Vec3d& b, const Vec3d& c);
  // Occluded: every pixel that the box's projection may touch has something nearer than all of the box.
  BoxVerdict judge(const OrientedBox& box) const;

 private:
  View view_;
  std::vector<float> inverseZ_;  // of the nearest, 1/m; 0: sky
};

}  // namespace eye
