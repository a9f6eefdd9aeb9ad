#include "bench/depth_probe.h"

#include <algorithm>
#include <cmath>

namespace eye {

DepthProbe::DepthProbe(const View& view)
    : view_(view),
      pixelsPerTan_(view.widthPx / (view.frustum.tanRight - view.frustum.tanLeft)),
      inverseZ_(static_cast<size_t>(view.widthPx) * static_cast<size_t>(view.heightPx), 0.0f) {}

DepthProbe::Projected DepthProbe::project(const Vec3d& eyeM) const {
  return {(eyeM.x / eyeM.z - view_.frustum.tanLeft) * pixelsPerTan_,
          (eyeM.y / eyeM.z + view_.frustum.tanTop) * pixelsPerTan_, 1.0 / eyeM.z};
}

void DepthProbe::draw(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  std::array<Projected, 3> p;
  const std::array<Vec3d, 3> corners{view_.eyeFromEcef * a, view_.eyeFromEcef * b, view_.eyeFromEcef * c};
  for (size_t i = 0; i < 3; ++i) {
    if (corners[i].z < view_.frustum.nearM) return;
    p[i] = project(corners[i]);
  }
  const double area = (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[1].y - p[0].y) * (p[2].x - p[0].x);
  if (area == 0) return;
  const auto first = [](double low) { return static_cast<int>(std::clamp(std::ceil(low - 0.5), 0.0, 1e6)); };
  const auto last = [](double high, int size) {
    return static_cast<int>(std::clamp(std::floor(high - 0.5), -1.0, size - 1.0));
  };
  const int x0 = first(std::min({p[0].x, p[1].x, p[2].x})),
            x1 = last(std::max({p[0].x, p[1].x, p[2].x}), view_.widthPx);
  const int y0 = first(std::min({p[0].y, p[1].y, p[2].y})),
            y1 = last(std::max({p[0].y, p[1].y, p[2].y}), view_.heightPx);
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      const double dx = x + 0.5 - p[0].x, dy = y + 0.5 - p[0].y;
      const double u = (dx * (p[2].y - p[0].y) - dy * (p[2].x - p[0].x)) / area;
      const double v = (dy * (p[1].x - p[0].x) - dx * (p[1].y - p[0].y)) / area;
      if (u < 0 || v < 0 || u + v > 1) continue;
      // 1/z is linear on the screen.
      const double here = p[0].inverseZ + u * (p[1].inverseZ - p[0].inverseZ) + v * (p[2].inverseZ - p[0].inverseZ);
      float& stored = inverseZ_[static_cast<size_t>(y) * static_cast<size_t>(view_.widthPx) + static_cast<size_t>(x)];
      stored = std::max(stored, static_cast<float>(here));
    }
  }
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
    const Projected on = project(p);
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
