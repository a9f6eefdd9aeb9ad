#include "predict/position_filter.h"

#include <algorithm>
#include <cmath>

namespace eye {
namespace {

// Between two origins the vertical turns by less than a thousandth, and positions are exact to a picometre.
constexpr double kReanchorM = 5000;
// What is known of derivatives before anything is measured: any aircraft's.
constexpr double kStartAccelerationMS2 = 100, kStartJerkMS3 = 100;

Vec3d derivative(const std::array<AxisKalman, 3>& axes, int order) {
  return Vec3d(axes[0].state(order), axes[1].state(order), axes[2].state(order));
}

}  // namespace

void PositionFilter::anchorAt(const Vec3d& ecefM) {
  originEcefM_ = ecefM;
  const Geodetic origin = geodeticFromEcef(ecefM);
  ecefFromEnu_ = ecefFromEnu(origin.latDeg, origin.lonDeg);
}

void PositionFilter::start(const Vec3d& ecefM, const Vec3d& velocityEcefMS, double velocitySigmaMS,
                           const AxisNoise& noise) {
  anchorAt(ecefM);
  const Vec3d velocityEnuMS = glm::transpose(ecefFromEnu_) * velocityEcefMS;
  for (int axis = 0; axis < 3; ++axis) {
    const double sigmas[kMaxAxisStates] = {std::sqrt(noise.measurementVarianceM2[axis]), velocitySigmaMS,
                                           kStartAccelerationMS2, kStartJerkMS3};
    AxisKalman& kalman = axes_[static_cast<size_t>(axis)];
    kalman.state = AxisVector::Zero(axisStates_);
    kalman.state(1) = velocityEnuMS[axis];
    kalman.covariance = AxisMatrix::Zero(axisStates_, axisStates_);
    for (int i = 0; i < axisStates_; ++i) kalman.covariance(i, i) = sigmas[i] * sigmas[i];
  }
}

void PositionFilter::predict(double stepS, const AxisNoise& noise) {
  for (size_t axis = 0; axis < 3; ++axis) axes_[axis].predict(stepS, noise.processNoise[axis]);
}

PositionFilter::Innovation PositionFilter::innovation(const Vec3d& measuredEcefM, const AxisNoise& noise) const {
  const Vec3d measuredEnuM = glm::transpose(ecefFromEnu_) * (measuredEcefM - originEcefM_);
  Innovation result;
  for (int axis = 0; axis < 3; ++axis) {
    const AxisKalman& kalman = axes_[static_cast<size_t>(axis)];
    result.valueM[axis] = measuredEnuM[axis] - kalman.state(0);
    result.varianceM2[axis] = kalman.covariance(0, 0) + noise.measurementVarianceM2[axis];
    result.nis += result.valueM[axis] * result.valueM[axis] / result.varianceM2[axis];
  }
  return result;
}

void PositionFilter::update(const Innovation& innovation, const AxisNoise& noise) {
  for (size_t axis = 0; axis < 3; ++axis)
    axes_[axis].update(innovation.valueM[axis], noise.measurementVarianceM2[axis]);
  if (glm::length(derivative(axes_, 0)) > kReanchorM) reanchor();
}

void PositionFilter::reanchor() {
  const Mat3d oldEcefFromEnu = ecefFromEnu_;
  anchorAt(originEcefM_ + ecefFromEnu_ * derivative(axes_, 0));
  const Mat3d newFromOld = glm::transpose(ecefFromEnu_) * oldEcefFromEnu;

  const std::array<AxisKalman, 3> old = axes_;
  for (int order = 0; order < axisStates_; ++order) {
    const Vec3d turned = order == 0 ? Vec3d(0.0) : newFromOld * derivative(old, order);
    for (int axis = 0; axis < 3; ++axis) axes_[static_cast<size_t>(axis)].state(order) = turned[axis];
  }
  // The diagonal blocks of the turned covariance. The others would hold the vertical's difference from the horizontal
  // times the angle between the verticals; the noises themselves belong to the local vertical, so the axes stay apart.
  for (int axis = 0; axis < 3; ++axis) {
    AxisMatrix& covariance = axes_[static_cast<size_t>(axis)].covariance;
    covariance.setZero();
    for (int from = 0; from < 3; ++from) {
      const double share = newFromOld[from][axis] * newFromOld[from][axis];
      covariance += share * old[static_cast<size_t>(from)].covariance;
    }
  }
}

PositionEstimate PositionFilter::at(double horizonS, const AxisNoise& noise) const {
  Vec3d positionEnuM, velocityEnuMS, varianceM2;
  const AxisMatrix a = transition(axisStates_, horizonS);
  for (int axis = 0; axis < 3; ++axis) {
    const AxisKalman& kalman = axes_[static_cast<size_t>(axis)];
    positionEnuM[axis] = a.row(0).dot(kalman.state);
    velocityEnuMS[axis] = a.row(1).dot(kalman.state);
    varianceM2[axis] = predictedCovariance(kalman.covariance, noise.processNoise[axis], horizonS)(0, 0);
  }
  PositionEstimate estimate;
  estimate.ecefM = originEcefM_ + ecefFromEnu_ * positionEnuM;
  estimate.velocityEcefMS = ecefFromEnu_ * velocityEnuMS;
  for (int axis = 0; axis < 3; ++axis)  // exactly symmetric so
    estimate.covarianceEcefM2 += varianceM2[axis] * glm::outerProduct(ecefFromEnu_[axis], ecefFromEnu_[axis]);
  estimate.horizontalSigmaM = std::sqrt(std::max(varianceM2[0], varianceM2[1]));
  return estimate;
}

}  // namespace eye
