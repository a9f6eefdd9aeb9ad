#include "predict/axis_kalman.h"

#include <cmath>

namespace eye {

AxisMatrix transition(int states, double stepS) {
  AxisMatrix a = AxisMatrix::Identity(states, states);
  for (int row = 0; row < states; ++row) {
    for (int column = row + 1; column < states; ++column) a(row, column) = a(row, column - 1) * stepS / (column - row);
  }
  return a;
}

AxisMatrix processNoise(int states, double density, double stepS) {
  // An impulse of the noise t seconds ago has moved state i by t^n/n! with n = states - 1 - i; the product of two such
  // responses, integrated over the step.
  const double t = std::abs(stepS);
  double response[kMaxAxisStates], power = 1;
  for (int i = states - 1; i >= 0; --i) {
    response[i] = power;
    power *= t / (states - i);
  }
  AxisMatrix q(states, states);
  for (int row = 0; row < states; ++row) {
    for (int column = 0; column < states; ++column)
      q(row, column) = density * response[row] * response[column] * t / (2 * states - 1 - row - column);
  }
  return q;
}

AxisMatrix predictedCovariance(const AxisMatrix& covariance, double density, double stepS) {
  const int states = static_cast<int>(covariance.rows());
  const AxisMatrix a = transition(states, stepS);
  const AxisMatrix half = a.lazyProduct(covariance);
  AxisMatrix next = half.lazyProduct(a.transpose());
  next += processNoise(states, density, stepS);
  return next;
}

AxisVector measure(AxisMatrix& covariance, double measurementVariance) {
  const Eigen::Index states = covariance.rows();
  AxisVector gain = covariance.col(0) / (covariance(0, 0) + measurementVariance);
  // (I - K C) P (I - K C)^T + K R K^T, where C takes the first state.
  AxisMatrix keep = AxisMatrix::Identity(states, states);
  keep.col(0) -= gain;
  const AxisMatrix half = keep.lazyProduct(covariance);
  AxisMatrix next = half.lazyProduct(keep.transpose());
  next += measurementVariance * gain.lazyProduct(gain.transpose());
  covariance = 0.5 * (next + next.transpose());
  return gain;
}

void AxisKalman::predict(double stepS, double density) {
  const AxisVector next = transition(static_cast<int>(state.size()), stepS).lazyProduct(state);
  state = next;
  covariance = predictedCovariance(covariance, density, stepS);
}

void AxisKalman::update(double innovation, double measurementVariance) {
  state += measure(covariance, measurementVariance) * innovation;
}

}  // namespace eye
