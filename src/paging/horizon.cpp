#include "paging/horizon.h"

#include <algorithm>
#include <cmath>

#include "paging/lod_select.h"
#include "terrain/extent.h"

namespace eye {
namespace {

const Vec3d kSemiAxesM{kSemiMajorM, kSemiMajorM, kSemiMinorM};
// Below the ellipsoid no further than this: whatever needs more (a globe of roots) hides nothing.
constexpr double kDeepestM = 200e3;
// Descendants are up to twice the error higher, along the ellipsoid's normal. That is up to 0.2 degrees off the radius,
// which moves them sideways: worth less than another hundredth of the height.
constexpr double kRaise = 2.02;
// An eye under the ellipsoid is over one lowered by so much more, and by a thousandth of its depth.
constexpr double kUnderEyeM = 10;

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

Horizon::Horizon(const Vec3d& eyeEcefM, double depthM) : depthM_(std::max(depthM, 0.0)), eyeEcefM_(eyeEcefM) {
  if (!(depthM_ < kDeepestM)) return;
  // Uniform scaling lowers the surface by (1 - shrink) r along the radius, which is at most 0.2 degrees off the normal:
  // along the normal by at least 0.99999 (1 - shrink) b.
  shrink_ = 1.0 - 1.0001 * depthM_ / kSemiMinorM;
  eyeScaled_ = eyeEcefM / (kSemiAxesM * shrink_);
  const double horizonSquared = glm::dot(eyeScaled_, eyeScaled_) - 1.0;
  eyeOutside_ = horizonSquared > 0.0;
  if (eyeOutside_) reachM_ = kSemiMajorM * shrink_ * std::sqrt(horizonSquared);
}

bool Horizon::hides(const ChunkMeta& meta, HorizonTest test) const {
  if (!eyeOutside_ || test == HorizonTest::none) return false;
  return test == HorizonTest::ellipsoid ? hidesPoint(meta) : hidesSphere(meta);
}

// Scaled space is a sphere of radius 1 (the full ellipsoid) round a sphere of radius k = shrink. A point p at 1 / cos t
// stands for the vertices at (angle a from p, radius r) with a + acos(1/r) <= t. Hidden by the smaller sphere and
// raised by a factor g they need a + acos(k / (g r)), which is at most t + acos(k/g): the difference of the two arc
// cosines is greatest at r = 1.
bool Horizon::hidesPoint(const ChunkMeta& meta) const {
  const double lengthSquared = glm::dot(meta.horizonPointScaled, meta.horizonPointScaled);
  if (!(lengthSquared > 0.5) || !(lengthSquared < 1e12)) return false;  // no point: never hidden
  const double cosPoint = std::min(1.0, 1.0 / std::sqrt(lengthSquared));
  const double sinPoint = std::sqrt(1.0 - cosPoint * cosPoint);
  const double cosRaise = shrink_ * (1.0 - kRaise * meta.geometricErrorM / kSemiMinorM);  // <= k / g
  if (cosRaise <= 0.0) return false;
  const double cosRaised = cosPoint * cosRaise - sinPoint * std::sqrt(std::max(0.0, 1.0 - cosRaise * cosRaise));
  if (cosRaised <= 1e-6) return false;  // a quarter of the globe and more: no one point stands for it
  const double lengthRaised = 1.0 / cosRaised;
  return belowHorizon(eyeScaled_, meta.horizonPointScaled * (lengthRaised / std::sqrt(lengthSquared)));
}

// An Earth of radius R hides a sphere of radius r when it lies behind the plane of R's horizon circle and inside the
// cone through it: when its centre is farther from the eye than that of a like sphere that touches the cone from inside
// at the same height. (The paper's text has the distance to the Earth's centre there; its figure means this one.) R is
// the radius of a sphere inside the lowered ellipsoid, and no more than the chunk's own lowest: a trench nearer than
// the horizon is not hidden by an Earth that it lies below.
bool Horizon::hidesSphere(const ChunkMeta& meta) const {
  const double mayRiseM = 2.0 * meta.geometricErrorM;
  const double lowestM = distanceToBox(Vec3d(0), meta.box) - mayRiseM;
  const double occluderM = std::min(kSemiMinorM * shrink_, lowestM);
  const double radiusM = (meta.sphereRadiusM + mayRiseM) * (1.0 + 1e-12);
  if (!(radiusM < occluderM)) return false;  // it may hold the Earth
  const double toHorizonSquared = glm::dot(eyeEcefM_, eyeEcefM_) - occluderM * occluderM;
  const double innerM = occluderM - radiusM;
  const double beyondSquared = glm::dot(meta.sphereCentreEcefM, meta.sphereCentreEcefM) - innerM * innerM;
  if (!(beyondSquared > 0.0)) return false;  // nothing of it is above the occluder
  const double touchingM = std::sqrt(toHorizonSquared) + std::sqrt(beyondSquared);
  const Vec3d fromEyeM = meta.sphereCentreEcefM - eyeEcefM_;
  return glm::dot(fromEyeM, fromEyeM) > touchingM * touchingM + radiusM * radiusM;
}

Horizon horizonForTolerance(const Vec3d& eyeEcefM, double greatestErrorM, double tolerancePerM) {
  const double altM = geodeticFromEcef(eyeEcefM).altM;
  const double leastM = altM < 0 ? kUnderEyeM - 1.001 * altM : 0.0;
  Horizon horizon(eyeEcefM, leastM);
  // Twice the error: heights in the metadata may or may not be widened by it. Depth and reach depend on each other; a
  // few steps come near the fixed point, and the walk checks what is left.
  for (int i = 0; i < 6; ++i) {
    const double sagM = 2 * std::min(1.05 * tolerancePerM * horizon.reachM(), greatestErrorM);
    horizon = Horizon(eyeEcefM, std::max(leastM, sagM));
  }
  return horizon;
}

}  // namespace eye
