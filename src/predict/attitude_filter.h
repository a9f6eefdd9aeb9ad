// The viewpoint's attitude and its rate of turning, as a rotation: no angle wraps, no attitude is singular.
#pragma once

#include <glm/gtc/quaternion.hpp>

#include "geo/frames.h"
#include "predict/axis_kalman.h"

namespace eye {

// Body to ecef.
glm::dquat attitudeOf(const Pose& pose);
// The pose of a body at `position`; with the nose vertical its roll is 0.
Pose poseWithAttitude(const Geodetic& position, const glm::dquat& ecefFromBody);

// A Kalman filter over rotation vectors in the body's frame: angle and rate about each axis, driven by white angular
// acceleration. All axes share one covariance, since their noises are the same.
class AttitudeFilter {
 public:
  void start(const glm::dquat& measured);
  // Further than 45 degrees from what was foreseen is another attitude, not a turn to it: begins anew there.
  void observe(double stepS, const glm::dquat& measured);

  // A turn about the vertical (`upEcef`) lasts; a roll or a pull soon ends in its attitude, and fades with the horizon.
  glm::dquat at(double horizonS, const Vec3d& upEcef) const;
  const Vec3d& rateBodyRadS() const { return rateBodyRadS_; }
  // About the vertical, clockwise seen from above.
  double turnRateRadS(const Vec3d& upEcef) const;

 private:
  glm::dquat attitude_{1, 0, 0, 0};
  Vec3d rateBodyRadS_{};
  AxisMatrix covariance_;
};

}  // namespace eye
