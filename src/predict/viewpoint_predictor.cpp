#include "predict/viewpoint_predictor.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace eye {
namespace {

constexpr double kRadius98 = 2.797;
constexpr double kLeastHorizonS = -1, kMostHorizonS = 30;

constexpr double kResetS = 1;           // packets overtake one another by less
constexpr double kLongestGapS = 10;     // after that the old state says nothing
constexpr double kGapSteps = 5;         // a gap, in usual steps
constexpr double kStandsStillS = 0.25;  // a moving host that shows one place for so long has stopped there
constexpr double kGateNis = 30.66;      // chi-square of 3 degrees of freedom exceeds it once in a million
constexpr double kPullMS2 = 9.8;        // sigma of an acceleration that begins between two observations
constexpr int kTeleportRun = 3;         // so many outliers in a row are a new place; fewer are a packet gone astray
constexpr double kTeleportM = 500;      // one outlier as far as that is a new place at once
constexpr double kAnySpeedMS = 1e4;     // sigma of an unknown velocity: an orbit's too
constexpr double kShiftSpeedMS = 50;    // sigma of a velocity that may have changed in a shift, beside its own size
constexpr int kNisMemory = 256;
constexpr double kFarthestM = 1e9;  // altitude: beyond the moon

// Tuned so that NIS is about 1 in standard-rate turns and reversals at 300 m/s with noise of 2 m at 60 Hz.
double modelNoise(int states) {
  return states == 6 ? 60 : 20;  // of acceleration; of jerk, and of snap
}

int axisStates(const PredictorOptions& options) {
  EYE_CHECK(options.states == 6 || options.states == 9 || options.states == 12);
  EYE_CHECK(options.measurementSigmaM > 0 && options.processNoise.value_or(1) > 0);
  return options.states / 3;
}

bool isBelievable(double timeS, const Pose& pose) {
  const Geodetic& at = pose.position;
  return std::isfinite(timeS) && std::abs(at.latDeg) <= 90 && std::abs(at.lonDeg) <= 360 &&
         std::abs(at.altM) <= kFarthestM && std::isfinite(pose.headingDeg) && std::isfinite(pose.pitchDeg) &&
         std::isfinite(pose.rollDeg);
}

double distanceM(const PositionFilter::Innovation& innovation) {
  return std::hypot(innovation.valueM[0], innovation.valueM[1], innovation.valueM[2]);
}

}  // namespace

ViewpointPredictor::ViewpointPredictor(const PredictorOptions& options)
    : configuredVarianceM2_(options.measurementSigmaM * options.measurementSigmaM),
      position_(axisStates(options)),
      horizontal_(options.processNoise.value_or(modelNoise(options.states)), options.measurementSigmaM, options.adapt),
      vertical_(horizontal_) {}

AxisNoise ViewpointPredictor::noise() const {
  const double across = horizontal_.measurementVarianceM2();
  return {{horizontal_.processNoise(), horizontal_.processNoise(), vertical_.processNoise()},
          {across, across, vertical_.measurementVarianceM2()}};
}

void ViewpointPredictor::start(double timeS, const Pose& pose, const Vec3d& ecefM, const Guess& guess) {
  if (started_) ++counts_.restarts;
  position_.start(ecefM, guess.velocityEcefMS, guess.sigmaMS, noise());
  attitude_.start(attitudeOf(pose));
  horizontal_.restart();
  vertical_.restart();
  started_ = true;
  seenS_ = believedS_ = timeS;
  newest_ = pose;
  outliersInARow_ = 0;
  nis_ = 0;
}

void ViewpointPredictor::observe(double timeS, const Pose& pose) {
  ++counts_.observations;
  if (!isBelievable(timeS, pose)) {
    ++counts_.refused;
    return;
  }
  const Vec3d ecefM = ecefFromGeodetic(pose.position);
  if (!isInOrder(timeS, pose, ecefM)) return;

  const double stepS = timeS - believedS_;
  PositionFilter foreseen = position_;
  foreseen.predict(stepS, noise());
  const PositionFilter::Innovation innovation = foreseen.innovation(ecefM, noise());
  if (gateNis(innovation, stepS) > kGateNis) {
    ++counts_.outliers;
    ++outliersInARow_;
    if (!beginsAnew(innovation)) return;
    ++counts_.teleports;
    // A short way off it is likely the same flight, and its velocity a guess; but the same place again is a standstill.
    const bool isShift = pose != newest_ && distanceM(innovation) < kTeleportM;
    const Vec3d velocityEcefMS = isShift ? position_.at(0, noise()).velocityEcefMS : Vec3d(0.0);
    start(timeS, pose, ecefM, {velocityEcefMS, isShift ? kShiftSpeedMS + glm::length(velocityEcefMS) : kAnySpeedMS});
    return;
  }
  outliersInARow_ = 0;
  position_ = foreseen;
  position_.update(innovation, noise());
  attitude_.observe(stepS, attitudeOf(pose));
  believedS_ = timeS;
  newest_ = pose;
  learn(innovation);
}

// The normalised innovation squared, with more variance than the stream has shown: that of the configured measurement,
// for the packet that a network holds up, and that of a pull that began right after the observation before.
double ViewpointPredictor::gateNis(const PositionFilter::Innovation& innovation, double stepS) const {
  const AxisNoise now = noise();
  const double pullM = kPullMS2 * stepS * stepS / 2;
  double nis = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double lackingM2 = std::max(configuredVarianceM2_ - now.measurementVarianceM2[axis], 0.0) + pullM * pullM;
    nis += innovation.valueM[axis] * innovation.valueM[axis] / (innovation.varianceM2[axis] + lackingM2);
  }
  return nis;
}

// Whether the observation is the next one in time. Begins anew, or counts and skips it, where it is not.
bool ViewpointPredictor::isInOrder(double timeS, const Pose& pose, const Vec3d& ecefM) {
  const double stepS = timeS - seenS_;
  const bool isReset = started_ && stepS < -kResetS, isLost = started_ && timeS - believedS_ > kLongestGapS;
  if (isReset) ++counts_.resets;
  if (started_ && usualStepS_ > 0 && stepS > kGapSteps * usualStepS_) ++counts_.gaps;
  if (!started_ || isReset || isLost) {
    start(timeS, pose, ecefM, {Vec3d(0.0), kAnySpeedMS});
    return false;
  }
  if (stepS == 0) ++counts_.repeated;
  if (stepS < 0) ++counts_.late;
  if (stepS <= 0) return false;
  usualStepS_ = usualStepS_ > 0 ? usualStepS_ + (stepS - usualStepS_) / 16 : stepS;
  seenS_ = timeS;
  if (pose == newest_ && timeS - believedS_ < kStandsStillS) {
    ++counts_.duplicates;
    return false;
  }
  return true;
}

bool ViewpointPredictor::beginsAnew(const PositionFilter::Innovation& innovation) const {
  return distanceM(innovation) > kTeleportM || outliersInARow_ >= kTeleportRun;
}

void ViewpointPredictor::learn(const PositionFilter::Innovation& innovation) {
  nis_ = innovation.nis;
  nisCount_ = std::min(nisCount_ + 1, kNisMemory);
  nisMean_ += (nis_ / 3 - nisMean_) / nisCount_;
  double whitened[3];
  for (int axis = 0; axis < 3; ++axis)
    whitened[axis] = innovation.valueM[axis] / std::sqrt(innovation.varianceM2[axis]);
  horizontal_.observe({whitened, 2});
  vertical_.observe({whitened + 2, 1});
}

Prediction ViewpointPredictor::at(double timeS) const {
  Prediction result;
  result.valid = started_;
  if (!started_) return result;
  result.horizonS = std::isfinite(timeS) ? std::clamp(timeS - believedS_, kLeastHorizonS, kMostHorizonS) : 0;
  result.timeS = believedS_ + result.horizonS;

  AxisNoise future = noise();
  future.processNoise[0] = future.processNoise[1] = horizontal_.futureProcessNoise();
  future.processNoise[2] = vertical_.futureProcessNoise();
  const PositionEstimate estimate = position_.at(result.horizonS, future);
  result.ecefM = estimate.ecefM;
  result.velocityEcefMS = estimate.velocityEcefMS;
  result.covarianceEcefM2 = estimate.covarianceEcefM2;
  result.radius98M = kRadius98 * estimate.horizontalSigmaM;

  const Geodetic position = geodeticFromEcef(estimate.ecefM);
  const Vec3d upEcef = upAt(position.latDeg, position.lonDeg);
  result.pose = poseWithAttitude(position, attitude_.at(result.horizonS, upEcef));
  result.rateBodyRadS = attitude_.rateBodyRadS();
  result.turnRateDegS = degFromRad(attitude_.turnRateRadS(upEcef));
  return result;
}

PredictorState ViewpointPredictor::state() const {
  return {.counts = counts_,
          .nis = nis_,
          .nisMean = nisMean_,
          .horizontalProcessNoise = horizontal_.processNoise(),
          .verticalProcessNoise = vertical_.processNoise(),
          .horizontalSigmaM = std::sqrt(horizontal_.measurementVarianceM2()),
          .verticalSigmaM = std::sqrt(vertical_.measurementVarianceM2())};
}

}  // namespace eye
