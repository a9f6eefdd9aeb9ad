// Where the viewpoint will be: a Kalman predictor over the stream of poses that a host sends, for the pager's
// look-ahead and for the eye of the frame that is drawn. Equations and measurements: docs/PREDICTION.md.
#pragma once

#include <cstdint>
#include <optional>

#include "geo/frames.h"
#include "predict/attitude_filter.h"
#include "predict/noise_estimate.h"
#include "predict/position_filter.h"

namespace eye {

struct PredictorOptions {
  int states = 9;  // 6: constant velocity, 9: constant acceleration, 12: constant jerk
  // Density of the white noise that drives the model, greater than 0; the model's own when absent. 6 states: m²/s³,
  // 9: m²/s^5, 12: m²/s^7.
  std::optional<double> processNoise;
  double measurementSigmaM = 2;  // of each axis, greater than 0
  bool adapt = true;             // both noises are where the estimate from the stream begins, or what they stay
};

struct Prediction {
  bool valid = false;  // false until there is an observation; the rest is then without meaning
  double timeS = 0;
  double horizonS = 0;  // beyond the newest observation that was believed; limited to [-1, 30]
  Pose pose;
  Vec3d ecefM{}, velocityEcefMS{};
  Mat3d covarianceEcefM2{0.0};  // of the position
  // The viewpoint is within this distance, horizontally, with a probability of 98 %. In the plane distances are
  // Rayleigh's: sqrt(-2 ln 0.02) = 2.797 sigma (2.326 would be a line's, 3.137 space's).
  double radius98M = 0;
  Vec3d rateBodyRadS{};     // about nose, right wing and belly: has no singularity where heading has
  double turnRateDegS = 0;  // about the vertical, clockwise
};

// What came in that was no simple next observation.
struct PredictorCounts {
  uint64_t observations = 0;  // all of them
  uint64_t refused = 0;       // not finite, or no place on Earth
  uint64_t repeated = 0;      // the stamp before once more: skipped
  uint64_t late = 0;          // an older stamp, by less than a reset: skipped
  uint64_t duplicates = 0;    // the same pose with a new stamp, soon after: skipped
  uint64_t gaps = 0;          // more than five times as late as usual; beyond 10 s it begins anew
  uint64_t outliers = 0;      // not believed
  uint64_t teleports = 0;     // began anew elsewhere
  uint64_t resets = 0;        // time went back: began anew
  uint64_t restarts = 0;      // began anew for whatever reason; the first beginning is none
};

struct PredictorState {
  PredictorCounts counts;
  double nis = 0;      // of the newest observation: chi-square, 3 degrees of freedom; 0 where the filter began
  double nisMean = 0;  // an axis, over some 250 observations: about 1 when the noises are right
  double horizontalProcessNoise = 0, verticalProcessNoise = 0;
  double horizontalSigmaM = 0, verticalSigmaM = 0;  // of the measurement
};

// Owner: render thread.
class ViewpointPredictor {
 public:
  explicit ViewpointPredictor(const PredictorOptions& options = {});

  // `timeS`: when the pose was true, on one clock for all of them. Anything may be passed.
  void observe(double timeS, const Pose& pose);
  // For any time, on the clock of the observations. Smooth in time; a time that is not finite counts as the newest.
  Prediction at(double timeS) const;
  PredictorState state() const;

 private:
  // A guess of the velocity, and how good it is.
  struct Guess {
    Vec3d velocityEcefMS{};
    double sigmaMS;
  };
  void start(double timeS, const Pose& pose, const Vec3d& ecefM, const Guess& guess);
  bool isInOrder(double timeS, const Pose& pose, const Vec3d& ecefM);
  double gateNis(const PositionFilter::Innovation& innovation, double stepS) const;
  bool beginsAnew(const PositionFilter::Innovation& innovation) const;
  void learn(const PositionFilter::Innovation& innovation);
  AxisNoise noise() const;

  double configuredVarianceM2_;
  PositionFilter position_;
  AttitudeFilter attitude_;
  NoiseEstimate horizontal_, vertical_;
  PredictorCounts counts_;
  bool started_ = false;
  double seenS_ = 0;      // newest stamp
  double believedS_ = 0;  // stamp of the filters' state
  double usualStepS_ = 0;
  Pose newest_;  // believed last
  int outliersInARow_ = 0;
  double nis_ = 0, nisMean_ = 0;
  int nisCount_ = 0;
};

}  // namespace eye
