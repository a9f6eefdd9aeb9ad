#include "bench/triangle_ids.h"

#include <algorithm>

#include "bench/rasterize.h"

namespace eye {

TriangleIds::TriangleIds(const View& view)
    : view_(view), inverseZ_(static_cast<size_t>(view.widthPx) * static_cast<size_t>(view.heightPx), 0.0) {
  ids_.resize(inverseZ_.size());
}

bool TriangleIds::draw(const Vec3d& a, const Vec3d& b, const Vec3d& c, uint32_t id) {
  if (glm::dot(glm::cross(b - a, c - a), a) >= 0) return false;
  bool covers = false;
  const auto paint = [&](size_t pixel, double inverseZ) {
    covers = true;
    if (inverseZ <= inverseZ_[pixel]) return;
    inverseZ_[pixel] = inverseZ;
    ids_[pixel] = id;
  };
  const std::array<Vec3d, 3> corners{view_.eyeFromEcef * a, view_.eyeFromEcef * b, view_.eyeFromEcef * c};
  const double nearM = view_.frustum.nearM;
  // Sutherland-Hodgman against the near plane: three or four corners are left, or none.
  std::array<Vec3d, 4> kept;
  size_t count = 0;
  for (size_t i = 0; i < 3; ++i) {
    const Vec3d& from = corners[i];
    const Vec3d& to = corners[(i + 1) % 3];
    if (from.z >= nearM) kept[count++] = from;
    if ((from.z >= nearM) != (to.z >= nearM)) kept[count++] = glm::mix(from, to, (nearM - from.z) / (to.z - from.z));
  }
  for (size_t i = 2; i < count; ++i) rasterize(view_, {kept[0], kept[i - 1], kept[i]}, paint);
  return covers;
}

std::vector<uint32_t> TriangleIds::visibleIds() const {
  std::vector<uint32_t> seen;
  for (size_t i = 0; i < ids_.size(); ++i)
    if (inverseZ_[i] > 0) seen.push_back(ids_[i]);
  std::ranges::sort(seen);
  seen.erase(std::ranges::unique(seen).begin(), seen.end());
  return seen;
}

size_t TriangleIds::pixelsShown() const {
  return static_cast<size_t>(std::ranges::count_if(inverseZ_, [](double inverseZ) { return inverseZ > 0; }));
}

}  // namespace eye
