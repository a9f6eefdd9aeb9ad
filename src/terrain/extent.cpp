#include "terrain/extent.h"

#include <algorithm>
#include <cmath>

namespace eye {

double distanceToBox(const Vec3d& pointEcefM, const OrientedBox& box) {
  const Vec3d fromCentreM = pointEcefM - box.centreEcefM;
  Vec3d outsideM = fromCentreM;
  for (const Vec3d& axis : box.halfAxesEcefM) {
    const double lengthSquared = glm::dot(axis, axis);
    if (lengthSquared <= 0) continue;
    const double along = std::clamp(glm::dot(fromCentreM, axis) / lengthSquared, -1.0, 1.0);
    outsideM -= along * axis;
  }
  return glm::length(outsideM);
}

float longestEdgeM(const ChunkMesh& mesh, double stepM) {
  const auto squared = [&](uint16_t a, uint16_t b) {
    const ChunkVertex &p = mesh.vertices[a], &q = mesh.vertices[b];
    const auto square = [](int steps) { return static_cast<float>(steps) * static_cast<float>(steps); };
    return square(p.x - q.x) + square(p.y - q.y) + square(p.z - q.z);
  };
  float longest = 0;
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const uint16_t a = mesh.indices[i], b = mesh.indices[i + 1], c = mesh.indices[i + 2];
    longest = std::max({longest, squared(a, b), squared(b, c), squared(c, a)});
  }
  return std::sqrt(longest) * static_cast<float>(stepM);
}

}  // namespace eye
