#include "predict/attitude_filter.h"

#include <cmath>

namespace eye {
namespace {

constexpr double kSigmaRad = 0.0005;     // 0.03 degrees: what angles of hosts jitter by
constexpr double kProcessNoise = 0.2;    // rad²/s³: a fighter's roll rate of 3 rad/s comes and goes in half a second
constexpr double kStartRateRadS = 5;     // before anything is known of it
constexpr double kJumpRad = 0.785;       // 45 degrees
constexpr double kFadingS = 1.0;         // how long a roll or a pull goes on, of the rates that are seen
constexpr double kVerticalLevel = 1e-9;  // the nose's level part, below which the heading is lost in rounding

glm::dquat rotationBy(const Vec3d& vectorRad) {
  const double angle = glm::length(vectorRad);
  // Exact to rounding below 1e-8, where sin(angle / 2) / angle is 1 / 2.
  const double scale = angle < 1e-8 ? 0.5 : std::sin(angle / 2) / angle;
  return glm::dquat(std::cos(angle / 2), vectorRad * scale);
}

// The short way round.
Vec3d vectorOf(glm::dquat q) {
  if (q.w < 0) q = -q;
  const Vec3d axis(q.x, q.y, q.z);
  const double sine = glm::length(axis);
  return sine < 1e-8 ? axis * 2.0 : axis * (2 * std::atan2(sine, q.w) / sine);
}

double degrees360(double rad) {
  const double deg = degFromRad(rad);
  return deg >= 0 ? deg : (deg + 360 < 360 ? deg + 360 : 0);
}

}  // namespace

glm::dquat attitudeOf(const Pose& pose) {
  return glm::quat_cast(ecefFromEnu(pose.position.latDeg, pose.position.lonDeg) *
                        enuFromBody(pose.headingDeg, pose.pitchDeg, pose.rollDeg));
}

Pose poseWithAttitude(const Geodetic& position, const glm::dquat& ecefFromBody) {
  const Mat3d enuFromBody =
      glm::transpose(ecefFromEnu(position.latDeg, position.lonDeg)) * glm::mat3_cast(ecefFromBody);
  const Vec3d &forward = enuFromBody[0], &right = enuFromBody[1], &down = enuFromBody[2];
  const double level = std::hypot(forward.x, forward.y);
  Pose pose{.position = position, .pitchDeg = degFromRad(std::atan2(forward.z, level))};
  if (level < kVerticalLevel) {
    pose.headingDeg = degrees360(std::atan2(-right.y, right.x));
    return pose;
  }
  pose.headingDeg = degrees360(std::atan2(forward.x, forward.y));
  pose.rollDeg = degFromRad(std::atan2(-right.z, -down.z));
  return pose;
}

void AttitudeFilter::start(const glm::dquat& measured) {
  attitude_ = measured;
  rateBodyRadS_ = Vec3d(0.0);
  covariance_ = AxisMatrix::Zero(2, 2);
  covariance_(0, 0) = kSigmaRad * kSigmaRad;
  covariance_(1, 1) = kStartRateRadS * kStartRateRadS;
}

void AttitudeFilter::observe(double stepS, const glm::dquat& measured) {
  const glm::dquat foreseen = attitude_ * rotationBy(rateBodyRadS_ * stepS);
  const Vec3d innovationRad = vectorOf(glm::conjugate(foreseen) * measured);
  if (glm::length(innovationRad) > kJumpRad) return start(measured);
  covariance_ = predictedCovariance(covariance_, kProcessNoise, stepS);
  const AxisVector gain = measure(covariance_, kSigmaRad * kSigmaRad);
  attitude_ = glm::normalize(foreseen * rotationBy(innovationRad * gain(0)));
  rateBodyRadS_ += innovationRad * gain(1);
}

glm::dquat AttitudeFilter::at(double horizonS, const Vec3d& upEcef) const {
  const Vec3d upBody = glm::conjugate(attitude_) * upEcef;
  const Vec3d lastingBodyRadS = upBody * glm::dot(upBody, rateBodyRadS_);
  const double fadingS = kFadingS * (1 - std::exp(-horizonS / kFadingS));
  return glm::normalize(attitude_ * rotationBy(lastingBodyRadS * horizonS) *
                        rotationBy((rateBodyRadS_ - lastingBodyRadS) * fadingS));
}

double AttitudeFilter::turnRateRadS(const Vec3d& upEcef) const {
  return -glm::dot(attitude_ * rateBodyRadS_, upEcef);
}

}  // namespace eye
