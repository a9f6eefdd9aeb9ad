#include "bake/mesh_bounds.h"

#include <algorithm>
#include <cmath>

namespace eye {
namespace {

// Doubles of ECEF hold about a nanometre; every bound is moved outwards by more than sums of them can be off.
constexpr double kOutwardM = 1e-3;
// Earth radii: below no horizon that an eye near the Earth has.
constexpr double kNeverBelow = 1e6;

// Ring & Cozzi (2013), "Computing the horizon occlusion point": on the ray through the box' centre, the point from
// which the cone that touches the unit sphere holds all vertices. Triangles lie in the vertices' hull, the cone is
// convex.
Vec3d horizonPoint(std::span<const Vec3d> verticesEcefM, const Vec3d& centreEcefM) {
  const Vec3d toScaled(1.0 / kSemiMajorM, 1.0 / kSemiMajorM, 1.0 / kSemiMinorM);
  const Vec3d direction = glm::normalize(centreEcefM * toScaled);
  double magnitude = 1.0;
  for (const Vec3d& p : verticesEcefM) {
    const Vec3d scaled = p * toScaled;
    const double length = std::max(glm::length(scaled), 1.0);  // below the ellipsoid: as if on it
    const Vec3d unit = glm::normalize(scaled);
    const double cosAlpha = glm::dot(unit, direction), sinAlpha = glm::length(glm::cross(unit, direction));
    const double cosBeta = 1.0 / length, sinBeta = std::sqrt(1.0 - cosBeta * cosBeta);
    const double denominator = cosAlpha * cosBeta - sinAlpha * sinBeta;
    if (denominator <= 1.0 / kNeverBelow) return direction * kNeverBelow;
    magnitude = std::max(magnitude, 1.0 / denominator);
  }
  return direction * (magnitude * (1.0 + 1e-9));
}

}  // namespace

void setBounds(std::span<const Vec3d> verticesEcefM, LatLon place, ChunkMeta& meta) {
  const Mat3d axes = ecefFromEnu(place.latDeg, place.lonDeg);
  // Sums relative to a vertex: small numbers.
  const Vec3d origin = verticesEcefM.front();
  Vec3d low(0.0), high(0.0);
  for (const Vec3d& p : verticesEcefM) {
    const Vec3d enu = (p - origin) * axes;  // the transpose: enu from ecef
    low = glm::min(low, enu);
    high = glm::max(high, enu);
  }
  const Vec3d half = (high - low) / 2.0 + kOutwardM;
  meta.box.centreEcefM = origin + axes * ((low + high) / 2.0);
  for (int i = 0; i < 3; ++i) meta.box.halfAxesEcefM[static_cast<size_t>(i)] = axes[i] * half[i];

  double radiusM = 0;
  for (const Vec3d& p : verticesEcefM) radiusM = std::max(radiusM, glm::length(p - meta.box.centreEcefM));
  meta.sphereCentreEcefM = meta.box.centreEcefM;
  meta.sphereRadiusM = radiusM + kOutwardM;
  meta.horizonPointScaled = horizonPoint(verticesEcefM, meta.box.centreEcefM);
}

}  // namespace eye
