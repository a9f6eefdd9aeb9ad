#include "bench/depth_probe.h"

#include <algorithm>
#include <cmath>

#include "bench/rasterize.h"

namespace eye {

DepthProbe::DepthProbe(const View& view)
    : view_(view), inverseZ_(static_cast<size_t>(view.widthPx) * static_cast<size_t>(view.heightPx), 0.0f) {}

void DepthProbe::draw(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const std::array<Vec3d, 3> corners{view_.eyeFromEcef * a, view_.eyeFromEcef * b, view_.eyeFromEcef * c};
  for (const Vec3d& corner : corners)
    if (corner.z < view_.frustum.nearM) return;
  rasterize(view_, corners, [this](size_t pixel, double inverseZ) {
    inverseZ_[pixel] = std::max(inverseZ_[pixel], static_cast<float>(inverseZ));
  });
}

BoxVerdict DepthProbe::judge(const OrientedBox& box) const {
  const FrustumPlanes planes = frustumPlanes(view_);
  const Vec3d centreM = box.centreEcefM - view_.eyeEcefM;
  for (size_t i = 0; i < planes.normalsEcef.size(); ++i) {
    double reachM = 0;
    for (const Vec3d& axis : box.halfAxesEcefM) reachM += std::abs(glm::dot(planes.normalsEcef[i], axis));
    if (glm::dot(planes.normalsEcef[i], centreM) + reachM < planes.offsetsM[i]) return BoxVerdict::outside;
  }
  double lowX = 1e9, lowY = 1e9, highX = -1e9, highY = -1e9, nearest = 0;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3d p = centreM;
    for (int a = 0; a < 3; ++a) p += box.halfAxesEcefM[static_cast<size_t>(a)] * ((corner >> a & 1) != 0 ? 1.0 : -1.0);
    p = view_.eyeFromEcef * p;
    if (p.z < view_.frustum.nearM) return BoxVerdict::visible;
    const Projected on = project(view_, p);
    lowX = std::min(lowX, on.x);
    highX = std::max(highX, on.x);
    lowY = std::min(lowY, on.y);
    highY = std::max(highY, on.y);
    nearest = std::max(nearest, on.inverseZ);
  }
  const auto pixel = [](double at, int size) { return static_cast<int>(std::clamp(std::floor(at), 0.0, size - 1.0)); };
  const int x0 = pixel(lowX, view_.widthPx), x1 = pixel(highX, view_.widthPx);
  for (int y = pixel(lowY, view_.heightPx); y <= pixel(highY, view_.heightPx); ++y) {
    const float* row = &inverseZ_[static_cast<size_t>(y) * static_cast<size_t>(view_.widthPx)];
    for (int x = x0; x <= x1; ++x) {
      if (row[x] <= nearest) return BoxVerdict::visible;
    }
  }
  return BoxVerdict::occluded;
}

}  // namespace eye
