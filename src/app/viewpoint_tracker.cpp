#include "app/viewpoint_tracker.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "link/angles.h"
#include "link/eye_chain.h"

namespace eye {
namespace {

// Without a prediction the speed still sets the pager's interval. Faster is a jump.
constexpr double kFastestMS = 10000;
constexpr double kRadPerDeg = std::numbers::pi / 180;
// A wider circle, as long as the predictor does not know the velocity or after seconds of a reversal, would ask for
// more of the finest ground than can be loaded, and the nearest not first.
constexpr double kGreatestRadiusM = 2000;
// The eye goes this long without a packet, then it waits.
constexpr double kFarthestExtrapolationS = 0.2;
// Up to so much jitter the filter foresees as smoothly as it looks back (30 ms: 0.17 m of stutter at 150 m/s either
// way), and each millisecond of delay would be one of transport delay. What is beyond it is waited for.
constexpr double kForeseenJitterS = 0.05, kLongestDelayS = 0.1;
// A host may say each pose several times; the same for longer is standing still.
constexpr double kStandsStillS = 0.25;
// Before the filter has seen so many it does not know the velocity.
constexpr int kFewestObservations = 12;
// Farther from the newest packet than twice what its age explains, and this, the filter is wrong.
constexpr double kBelievableM = 10;
constexpr double kSmoothing = 0.05;  // a frame's share in the mean frame rate and speed

double halfFovRad(const Frustum& frustum) {
  const double x = std::max(std::abs(frustum.tanLeft), std::abs(frustum.tanRight));
  const double y = std::max(std::abs(frustum.tanBottom), std::abs(frustum.tanTop));
  return std::atan(std::hypot(x, y));
}

PredictorOptions predictorOptions(const Options& options) {
  PredictorOptions predictor;
  predictor.states = options.predictorStates;
  predictor.processNoise = options.processNoise;
  if (options.measurementSigmaM) predictor.measurementSigmaM = *options.measurementSigmaM;
  predictor.adapt = !options.processNoise && !options.measurementSigmaM;
  return predictor;
}

}  // namespace

Pose channelPose(const Pose& aircraft, const Options& options) {
  if (!options.viewOffsetDeg) return aircraft;
  const auto& [headingDeg, pitchDeg, rollDeg] = *options.viewOffsetDeg;
  return poseFromBody(aircraft.position, ecefFromBody(aircraft) * parentFromBody(headingDeg, pitchDeg, rollDeg));
}

ViewpointTracker::ViewpointTracker(const Options& options) : options_(options), predictor_(predictorOptions(options)) {}

void ViewpointTracker::observe(const SourceSample& host, const Pose& pose, double nowS) {
  if (frames_ > 0 && nowS > nowS_) {  // the first ones count in full
    const double rateHz = std::min(1 / (nowS - nowS_), 1000.0);
    frameRateHz_ += std::max(kSmoothing, 1.0 / frames_) * (rateHz - frameRateHz_);
  }
  ++frames_;
  nowS_ = nowS;
  live_ = host.live && host.valid;
  jumped_ = false;
  if (live_ && host.arrivedNs == arrivedNs_) return;  // nothing new
  arrivedNs_ = host.arrivedNs;
  observePose(pose, live_ ? static_cast<double>(host.arrivedNs) * 1e-9 : nowS);
}

// `atS`: when the pose came, on the clock of the frames.
void ViewpointTracker::observePose(const Pose& pose, double atS) {
  const Vec3d eyeEcefM = ecefFromGeodetic(pose.position);
  const bool first = observations_ == 0;
  if (first || pose != pose_) changedS_ = atS;
  jumped_ = first;
  if (!first && atS > observedS_) {
    const double speedMS = glm::length(eyeEcefM - eyeEcefM_) / (atS - observedS_);
    if (speedMS < kFastestMS) speedMS_ += std::max(kSmoothing, 1.0 / observations_) * (speedMS - speedMS_);
    if (options_.predictor == PredictorMode::none) jumped_ = speedMS >= kFastestMS;
  }
  ++observations_;
  pose_ = pose;
  eyeEcefM_ = eyeEcefM;
  observedS_ = atS;
  if (options_.predictor == PredictorMode::none) return;

  if (live_) jitter_.observe(atS);
  ++sinceRestart_;
  predictor_.observe(atS, pose);
  if (const uint64_t restarts = predictor_.state().counts.restarts; restarts != restarts_) {
    restarts_ = restarts;
    jumped_ = true;
    sinceRestart_ = 0;
    foreseen_.clear();
    errorM_.reset();
  }
  while (!foreseen_.empty() && foreseen_.front().atS <= atS) {
    errorM_ = glm::length(foreseen_.front().ecefM - predictor_.at(foreseen_.front().atS).ecefM);
    foreseen_.pop_front();
  }
}

// Where predictions start: now, but not beyond what is believed of a host that has fallen silent.
double ViewpointTracker::knownS() const {
  return live_ ? std::min(nowS_, observedS_ + kFarthestExtrapolationS) : nowS_;
}

bool ViewpointTracker::isSilent() const {
  return live_ && nowS_ - observedS_ > kFarthestExtrapolationS;
}

DisplayedEye ViewpointTracker::eye() const {
  DisplayedEye eye{pose_};
  eye.silent = isSilent();
  if (!live_ || options_.hostDelay == HostDelayMode::off) return eye;
  if (observedS_ - changedS_ > kStandsStillS || sinceRestart_ < kFewestObservations) return eye;
  const double delayS = options_.hostDelay == HostDelayMode::fixed
                            ? options_.hostDelayMs * 1e-3
                            : std::clamp(jitter_.jitterS() - kForeseenJitterS, 0.0, kLongestDelayS);
  const Prediction prediction = predictor_.at(std::min(nowS_ - delayS, knownS()));
  const double ageS = std::abs(nowS_ - delayS - changedS_);
  const double offM = glm::length(prediction.ecefM - eyeEcefM_);
  if (!prediction.valid || offM > 2 * glm::length(prediction.velocityEcefMS) * ageS + kBelievableM) return eye;
  return {prediction.pose, delayS * 1e3, eye.silent};
}

ViewpointAhead ViewpointTracker::ahead(const Vec3d& nowForwardEcef, double inS) const {
  // A silent host's eye waits, and nobody knows where it will go on.
  const Prediction prediction =
      options_.predictor == PredictorMode::none ? Prediction{} : predictor_.at(knownS() + (isSilent() ? 0 : inS));
  if (!prediction.valid) return {inS, eyeEcefM_, pose_.position.altM, 0, nowForwardEcef, 0};
  const double turnRateRadS = prediction.turnRateDegS * kRadPerDeg;
  return {inS,
          prediction.ecefM,
          prediction.pose.position.altM,
          std::min(prediction.radius98M, kGreatestRadiusM),
          ecefFromBody(channelPose(prediction.pose, options_))[0],
          turnRateRadS};
}

LookAhead ViewpointTracker::lookAhead(const View& view) const {
  LookAhead look;
  look.nowS = nowS_;
  look.frameRateHz = frameRateHz_;
  look.speedMS = speedMS_;
  look.jumped = jumped_;
  look.region.pixelsPerRadian = pixelsPerRadian(view);
  look.region.ssePx = options_.ssePx;
  look.region.halfFovRad = halfFovRad(view.frustum);
  look.region.widening = options_.regionWidening;
  const Vec3d forwardEcef = ecefFromBody(channelPose(pose_, options_))[0];
  look.at = [this, forwardEcef](double inS) { return ahead(forwardEcef, inS); };
  return look;
}

PredictionRecord ViewpointTracker::record(double horizonS) {
  if (options_.predictor == PredictorMode::none || horizonS <= 0 || isSilent()) return {};
  const Prediction prediction = predictor_.at(nowS_ + horizonS);
  if (!prediction.valid) return {};
  // In the order of their times: a shorter horizon than before comes behind what is still awaited.
  if (foreseen_.empty() || foreseen_.back().atS < nowS_ + horizonS)
    foreseen_.push_back({nowS_ + horizonS, prediction.ecefM});
  return {horizonS, prediction.radius98M, errorM_};
}

}  // namespace eye
