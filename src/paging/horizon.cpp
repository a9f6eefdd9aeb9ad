#include "paging/horizon.h"

#include <algorithm>
#include <cmath>

#include "paging/lod_select.h"

namespace eye {
namespace {

const Vec3d kSemiAxesM{kSemiMajorM, kSemiMajorM, kSemiMinorM};
// Below the ellipsoid no further than this: whatever needs more (a globe of roots) hides nothing.
constexpr double kDeepestM = 200e3;

}  // namespace

// Occluded when the point is beyond the plane through the horizon circle and inside the cone from the eye through it.
// CesiumGS, "Horizon Culling" (25 April 2013). Inside the ellipsoid nothing is hidden.
bool belowHorizon(const Vec3d& eyeScaled, const Vec3d& pointScaled) {
  const double horizonSquared = glm::dot(eyeScaled, eyeScaled) - 1.0;
  if (horizonSquared < 0.0) return false;
  const Vec3d toPoint = pointScaled - eyeScaled;
  const double towardsCentre = -glm::dot(toPoint, eyeScaled);
  return towardsCentre > horizonSquared && towardsCentre * towardsCentre > horizonSquared * glm::dot(toPoint, toPoint);
}

Horizon::Horizon(const Vec3d& eyeEcefM, double depthM) : depthM_(std::max(depthM, 0.0)) {
  if (!(depthM_ < kDeepestM)) return;
  // Uniform scaling lowers the surface by (1 - shrink) r along the radius, which is at most 0.2 degrees off the normal:
  // along the normal by at least 0.99999 (1 - shrink) b.
  shrink_ = 1.0 - 1.0001 * depthM_ / kSemiMinorM;
  eyeScaled_ = eyeEcefM / (kSemiAxesM * shrink_);
  const double horizonSquared = glm::dot(eyeScaled_, eyeScaled_) - 1.0;
  eyeOutside_ = horizonSquared > 0.0;
  if (eyeOutside_) reachM_ = kSemiMajorM * shrink_ * std::sqrt(horizonSquared);
}

// Scaled space is a sphere of radius 1 (the full ellipsoid) round a sphere of radius k = shrink. A point p at 1 / cos t
// stands for the vertices at (angle a from p, radius r) with a + acos(1/r) <= t. Hidden by the smaller sphere and
// raised by a factor g they need a + acos(k / (g r)), which is at most t + acos(k/g): the difference of the two arc
// cosines is greatest at r = 1.
bool Horizon::hides(const ChunkMeta& meta) const {
  const double lengthSquared = glm::dot(meta.horizonPointScaled, meta.horizonPointScaled);
  if (!eyeOutside_ || !(lengthSquared > 0.5) || !(lengthSquared < 1e12)) return false;  // no point: never hidden
  const double cosPoint = std::min(1.0, 1.0 / std::sqrt(lengthSquared));
  const double sinPoint = std::sqrt(1.0 - cosPoint * cosPoint);
  const double cosRaise = shrink_ * (1.0 - 2.0 * meta.geometricErrorM / kSemiMinorM);  // <= k / g
  if (cosRaise <= 0.0) return false;
  const double cosRaised = cosPoint * cosRaise - sinPoint * std::sqrt(std::max(0.0, 1.0 - cosRaise * cosRaise));
  if (cosRaised <= 1e-6) return false;  // a quarter of the globe and more: no one point stands for it
  const double lengthRaised = 1.0 / cosRaised;
  return belowHorizon(eyeScaled_, meta.horizonPointScaled * (lengthRaised / std::sqrt(lengthSquared)));
}

Horizon horizonForTolerance(const Vec3d& eyeEcefM, double greatestErrorM, double tolerancePerM) {
  Horizon horizon(eyeEcefM, 0);
  // Twice the error: heights in the metadata may or may not be widened by it. Depth and reach depend on each other; a
  // few steps come near the fixed point, and the walk checks what is left.
  for (int i = 0; i < 6; ++i)
    horizon = Horizon(eyeEcefM, 2 * std::min(1.05 * tolerancePerM * horizon.reachM(), greatestErrorM));
  return horizon;
}

}  // namespace eye
