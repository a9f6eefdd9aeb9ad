// The viewpoint's position: three axes in a tangent frame (east, north, up) that goes with the aircraft.
#pragma once

#include <array>

#include "geo/frames.h"
#include "predict/axis_kalman.h"

namespace eye {

// Of the axes east, north and up. East and north share theirs, so that the frame may turn about the vertical, as it
// does at the poles, and the estimate stays what it was.
struct AxisNoise {
  double processNoise[3];
  double measurementVarianceM2[3];
};

struct PositionEstimate {
  Vec3d ecefM{}, velocityEcefMS{};
  Mat3d covarianceEcefM2{0.0};
  double horizontalSigmaM = 0;  // of one horizontal axis
};

class PositionFilter {
 public:
  // `axisStates`: 2 (constant velocity), 3 (constant acceleration), 4 (constant jerk).
  explicit PositionFilter(int axisStates) : axisStates_(axisStates) {}

  // A position is known and a velocity guessed; higher derivatives are about zero.
  void start(const Vec3d& ecefM, const Vec3d& velocityEcefMS, double velocitySigmaMS, const AxisNoise& noise);
  void predict(double stepS, const AxisNoise& noise);

  // The measurement is the position plus noise: z = O + nu.
  struct Innovation {
    double valueM[3], varianceM2[3];  // east, north, up
    double nis = 0;                   // normalised innovation squared, chi-square of 3 degrees of freedom
  };
  Innovation innovation(const Vec3d& measuredEcefM, const AxisNoise& noise) const;
  void update(const Innovation& innovation, const AxisNoise& noise);

  PositionEstimate at(double horizonS, const AxisNoise& noise) const;
  const Vec3d& originEcefM() const { return originEcefM_; }
  const std::array<AxisKalman, 3>& axes() const { return axes_; }

 private:
  void anchorAt(const Vec3d& ecefM);
  void reanchor();

  int axisStates_;
  Vec3d originEcefM_{};
  Mat3d ecefFromEnu_{1.0};
  std::array<AxisKalman, 3> axes_;  // metres from the origin, and derivatives
};

}  // namespace eye
