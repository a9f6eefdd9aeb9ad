// One axis of a Kalman filter: a quantity and its derivatives, of which only the quantity itself is measured.
#pragma once

#include <Eigen/Core>

namespace eye {

// Two to four states: the quantity, its rate, acceleration, jerk. Held in place: nothing here allocates.
inline constexpr int kMaxAxisStates = 4;
using AxisVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxAxisStates, 1>;
using AxisMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxAxisStates, kMaxAxisStates>;

// Taylor's series: row i is the i-th derivative after `stepS` seconds, the highest one held. Negative steps go back.
AxisMatrix transition(int states, double stepS);

// What white noise in the first derivative that is no state adds in |stepS| seconds. `density` in m²/s^(2 states - 1):
// for three states white jerk, q [t^5/20 t^4/8 t^3/6; t^4/8 t^3/3 t^2/2; t^3/6 t^2/2 t].
AxisMatrix processNoise(int states, double density, double stepS);

// The covariance `stepS` seconds on.
AxisMatrix predictedCovariance(const AxisMatrix& covariance, double density, double stepS);

// The covariance after a measurement of that variance, in Joseph's form and made symmetric, so that rounding never
// makes a variance negative. Gives the gain.
AxisVector measure(AxisMatrix& covariance, double measurementVariance);

struct AxisKalman {
  AxisVector state;
  AxisMatrix covariance;

  void predict(double stepS, double density);
  // `innovation`: the measured value less state(0).
  void update(double innovation, double measurementVariance);
};

}  // namespace eye
