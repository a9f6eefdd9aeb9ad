#include "link/angles.h"

#include <cmath>

namespace eye {

double wrappedDeg180(double deg) {
  if (deg >= -180.0 && deg < 180.0) return deg;
  return wrappedDeg360(deg + 180.0) - 180.0;
}

double wrappedDeg360(double deg) {
  if (deg >= 0.0 && deg < 360.0) return deg;
  const double wrapped = std::fmod(deg, 360.0);
  const double positive = wrapped < 0 ? wrapped + 360.0 : wrapped;
  return positive < 360.0 ? positive : 0.0;  // -1e-20 + 360 rounds to 360
}

void normaliseAngles(Pose& pose) {
  pose.pitchDeg = wrappedDeg180(pose.pitchDeg);
  if (std::abs(pose.pitchDeg) > 90.0) {
    pose.pitchDeg = std::copysign(180.0, pose.pitchDeg) - pose.pitchDeg;
    pose.headingDeg += 180.0;
    pose.rollDeg += 180.0;
  }
  pose.headingDeg = wrappedDeg360(pose.headingDeg);
  pose.rollDeg = wrappedDeg180(pose.rollDeg);
}

Mat3d ecefFromBody(const Pose& pose) {
  return ecefFromEnu(pose.position.latDeg, pose.position.lonDeg) *
         enuFromBody(pose.headingDeg, pose.pitchDeg, pose.rollDeg);
}

Pose poseFromBody(const Geodetic& position, const Mat3d& ecefFromBody) {
  const Mat3d enuFromBody = glm::transpose(ecefFromEnu(position.latDeg, position.lonDeg)) * ecefFromBody;
  const Vec3d &forwardEnu = enuFromBody[0], &rightEnu = enuFromBody[1], &downEnu = enuFromBody[2];
  const double level = std::hypot(forwardEnu.x, forwardEnu.y);

  Pose pose;
  pose.position = position;
  pose.pitchDeg = degFromRad(std::atan2(forwardEnu.z, level));
  // Below this the heading is lost in rounding (1e-9 of a rotation is 60 nanodegrees): take it from the wing instead.
  constexpr double kVertical = 1e-9;
  if (level < kVertical) {
    pose.headingDeg = wrappedDeg360(degFromRad(std::atan2(-rightEnu.y, rightEnu.x)));
    return pose;
  }
  pose.headingDeg = wrappedDeg360(degFromRad(std::atan2(forwardEnu.x, forwardEnu.y)));
  // Roll: how far the wing (right) and the belly (down) lean out of the vertical plane through the nose.
  pose.rollDeg = wrappedDeg180(degFromRad(std::atan2(-rightEnu.z, -downEnu.z)));
  return pose;
}

}  // namespace eye
