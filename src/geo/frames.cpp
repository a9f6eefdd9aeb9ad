#include "geo/frames.h"

#include <cmath>

#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/Math.hpp>

namespace eye {
namespace {

constexpr double kEccentricitySquared = kFlattening * (2.0 - kFlattening);

struct SinCos {
  double sin, cos;
};

// Exact at multiples of 90 degrees: the argument is reduced in degrees.
SinCos sinCosDeg(double deg) {
  SinCos result{};
  GeographicLib::Math::sincosd(deg, result.sin, result.cos);
  return result;
}

}  // namespace

Vec3d ecefFromGeodetic(const Geodetic& g) {
  const SinCos lat = sinCosDeg(g.latDeg), lon = sinCosDeg(g.lonDeg);
  const double primeVerticalM = kSemiMajorM / std::sqrt(1.0 - kEccentricitySquared * lat.sin * lat.sin);
  const double axisDistanceM = (primeVerticalM + g.altM) * lat.cos;
  const Vec3d ecefM(axisDistanceM * lon.cos, axisDistanceM * lon.sin,
                    (primeVerticalM * (1.0 - kEccentricitySquared) + g.altM) * lat.sin);
  return ecefM + Vec3d(0.0);  // turns -0 into +0: sin(-180) and sin(180) differ in it alone
}

Geodetic geodeticFromEcef(const Vec3d& ecefM) {
  Geodetic g;
  GeographicLib::Geocentric::WGS84().Reverse(ecefM.x, ecefM.y, ecefM.z, g.latDeg, g.lonDeg, g.altM);
  return g;
}

Vec3d upAt(double latDeg, double lonDeg) {
  const SinCos lat = sinCosDeg(latDeg), lon = sinCosDeg(lonDeg);
  return Vec3d(lat.cos * lon.cos, lat.cos * lon.sin, lat.sin);
}

Mat3d ecefFromEnu(double latDeg, double lonDeg) {
  const SinCos lat = sinCosDeg(latDeg), lon = sinCosDeg(lonDeg);
  const Vec3d east(-lon.sin, lon.cos, 0.0);
  const Vec3d north(-lat.sin * lon.cos, -lat.sin * lon.sin, lat.cos);
  return Mat3d(east, north, Vec3d(lat.cos * lon.cos, lat.cos * lon.sin, lat.sin));
}

Mat3d enuFromBody(double headingDeg, double pitchDeg, double rollDeg) {
  const SinCos heading = sinCosDeg(headingDeg), pitch = sinCosDeg(pitchDeg), roll = sinCosDeg(rollDeg);
  const Vec3d forward(heading.sin * pitch.cos, heading.cos * pitch.cos, pitch.sin);
  const Vec3d levelRight(heading.cos, -heading.sin, 0.0);
  const Vec3d levelDown = glm::cross(forward, levelRight);
  const Vec3d right = levelRight * roll.cos + levelDown * roll.sin;
  const Vec3d down = levelDown * roll.cos - levelRight * roll.sin;
  return Mat3d(forward, right, down);
}

Mat3d bodyFromEye() {
  return Mat3d(Vec3d(0, 1, 0), Vec3d(0, 0, 1), Vec3d(1, 0, 0));
}

Mat3d ecefFromEye(const Pose& pose) {
  return ecefFromEnu(pose.position.latDeg, pose.position.lonDeg) *
         enuFromBody(pose.headingDeg, pose.pitchDeg, pose.rollDeg) * bodyFromEye();
}

}  // namespace eye
