#include "render/sky_dome.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "shared/config.h"

namespace eye {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr uint32_t kMeridians = EYE_DOME_MERIDIANS, kRings = EYE_DOME_RINGS;

// The cone about the view's middle that holds all its corners.
struct Cone {
  Vec3d axisEcef;
  double halfRad;
};

Cone coneOf(const View& view) {
  const Frustum& f = view.frustum;
  const Vec3d axis = glm::normalize(Vec3d((f.tanLeft + f.tanRight) / 2, -(f.tanBottom + f.tanTop) / 2, 1));
  double leastCosine = 1;
  for (const double x : {f.tanLeft, f.tanRight})
    for (const double y : {f.tanBottom, f.tanTop})
      leastCosine = std::min(leastCosine, glm::dot(axis, glm::normalize(Vec3d(x, -y, 1))));
  return {glm::transpose(view.eyeFromEcef) * axis, std::acos(std::clamp(leastCosine, -1.0, 1.0))};
}

}  // namespace

double domeRingRad(uint32_t ring) {
  const double steps = static_cast<double>(ring) - kRings;
  const double share = std::abs(steps) / kRings;
  const double elevation = (std::exp(EYE_DOME_CROWDING * share) - 1) * (kPi / 2 / (std::exp(EYE_DOME_CROWDING) - 1));
  return std::copysign(elevation, steps);
}

Vec3d domeAhead(const Vec3d& upEcef) {
  const Vec3d aside = std::abs(upEcef.z) < 0.9 ? Vec3d(0, 0, 1) : Vec3d(1, 0, 0);
  return glm::normalize(aside - glm::dot(aside, upEcef) * upEcef);
}

double horizonRad(double heightM, double depthM) {
  // Of the balls within the ellipsoid that touch it below the eye, one as curved as the ellipsoid is anywhere (across
  // the equator's meridians, b * b / a) leaves the most sky. And what floats and roundings may ask for.
  constexpr double kLeastRadiusM = 6335439;
  constexpr double kMarginRad = 1e-3;
  // The lowered ellipsoid has the shape of the full one (paging/horizon.h): at the equator it is lower by 0.3 %.
  const double lowestM = depthM * (depthM > 0 ? 1.005 : 1);
  constexpr double kLeastAboveM = 10;
  if (!(heightM + depthM > kLeastAboveM)) return -kPi / 2;
  return -std::acos((kLeastRadiusM - lowestM) / (kLeastRadiusM + heightM)) - kMarginRad;
}

DomePart domePart(const View& view, const Vec3d& upEcef, const Vec3d& aheadEcef, double lowestRad) {
  const Cone cone = coneOf(view);
  const double elevation = std::asin(std::clamp(glm::dot(cone.axisEcef, upEcef), -1.0, 1.0));
  DomePart part;
  // A ring more to either side.
  uint32_t low = 0, high = 2 * kRings;
  while (low < high && domeRingRad(low + 1) < std::max(elevation - cone.halfRad, lowestRad)) ++low;
  while (high > low && domeRingRad(high - 1) > elevation + cone.halfRad) --high;
  part.firstRing = low;
  part.rings = high - low + 1;
  if (std::abs(elevation) + cone.halfRad >= kPi / 2) {  // over the zenith or the nadir
    part.strips = kMeridians;
    return part;
  }
  const double azimuth =
      std::atan2(glm::dot(cone.axisEcef, glm::cross(upEcef, aheadEcef)), glm::dot(cone.axisEcef, aheadEcef));
  const double halfRad = std::asin(std::min(std::sin(cone.halfRad) / std::cos(elevation), 1.0));
  const double perStrip = 2 * kPi / kMeridians;
  const double first = std::floor((azimuth - halfRad) / perStrip), last = std::floor((azimuth + halfRad) / perStrip);
  part.strips = std::min(static_cast<uint32_t>(last - first) + 1, kMeridians);
  part.firstStrip = static_cast<uint32_t>(first < 0 ? first + kMeridians : first);
  return part;
}

}  // namespace eye
