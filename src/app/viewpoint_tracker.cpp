#include "app/viewpoint_tracker.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "link/angles.h"
#include "link/eye_chain.h"
#include "predict/attitude_filter.h"

namespace eye {
namespace {

// Without a prediction the speed still sets the pager's interval. Faster is a jump.
constexpr double kFastestMS = 10000;
constexpr double kRadPerDeg = std::numbers::pi / 180;
// A wider circle, as long as the predictor does not know the velocity or after seconds of a reversal, would ask for
// more of the finest ground than can be loaded, and the nearest not first.
constexpr double kGreatestRadiusM = 2000;
// Up to so much jitter the filter foresees as smoothly as it looks back (30 ms: 0.17 m of stutter at 150 m/s either
// way), and each millisecond of delay would be one of transport delay. What is beyond it is waited for.
constexpr double kForeseenJitterS = 0.05, kLongestDelayS = 0.1;
// A host may say each pose several times; the same for longer is standing still.
constexpr double kStandsStillS = 0.25;
// Before the filter has seen so many it does not know the velocity.
constexpr int kFewestObservations = 12;
// Farther from the newest packet than twice what its age explains, and this, the filter is wrong.
constexpr double kBelievableM = 10;
// Slower, and where the aircraft is says nothing of when it was there.
constexpr double kSlowMS = 5;
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
  silent_ = live_ && host.isSilent(nowS);
  jumped_ = false;
  if (!live_) {
    observePose(pose, nowS);
    measureSpeed(nowS);
    return;
  }

  atS_ = static_cast<double>(host.atNs) * 1e-9;
  carryOnS_ = static_cast<double>(host.carryOnNs) * 1e-9;
  stampedByHost_ = host.stampedByHost;
  motion_ = host.motion;
  for (const StampedPose& heard : host.heard) hear(heard);
  // One that its host's rates move is seen anew in each frame.
  const double shownS = motion_ ? std::min(nowS, heldS()) : atS_;
  if (motion_) observePose(pose, shownS);
  pose_ = pose;
  measureSpeed(shownS);
}

void ViewpointTracker::hear(const StampedPose& heard) {
  const double atS = static_cast<double>(heard.atNs) * 1e-9, arrivedS = static_cast<double>(heard.arrivedNs) * 1e-9;
  if (stampedByHost_)
    jitter_.heldUp(arrivedS - atS);
  else
    jitter_.arrived(arrivedS);
  if (!motion_) {
    const uint64_t restarts = restarts_;
    observePose(heard.pose, atS);
    if (restarts_ != restarts) history_.clear();
  }
  history_.add(momentOf(heard), heard.pose);
}

// From the newest pose of an earlier frame to that of this one, which was true at `atS`.
void ViewpointTracker::measureSpeed(double atS) {
  const bool isNew = !measuredS_ || atS > *measuredS_;
  if (measuredS_ && isNew) {
    const double speedMS = glm::length(eyeEcefM_ - measuredEcefM_) / (atS - *measuredS_);
    if (speedMS < kFastestMS) speedMS_ += std::max(kSmoothing, 1.0 / ++speeds_) * (speedMS - speedMS_);
    if (!filterRuns()) jumped_ = speedMS >= kFastestMS;
  }
  if (!isNew) return;
  measuredS_ = atS;
  measuredEcefM_ = eyeEcefM_;
}

// When the pose was true. An arrival is late by what the network held the packet up, and poses at such times would make
// the aircraft go fast and slow; the filter's motion is even, so the moment is the one at which that passes the pose.
double ViewpointTracker::momentOf(const StampedPose& heard) const {
  const double atS = static_cast<double>(heard.atNs) * 1e-9;
  if (stampedByHost_ || motion_ || sinceRestart_ < kFewestObservations) return atS;
  const Prediction then = predictor_.at(atS);
  const double speedMS = glm::length(then.velocityEcefMS);
  if (!then.valid || speedMS < kSlowMS) return atS;
  const double aheadM = glm::dot(ecefFromGeodetic(heard.pose.position) - then.ecefM, then.velocityEcefMS / speedMS);
  return atS + std::clamp(aheadM / speedMS, -jitter_.jitterS(), jitter_.jitterS());
}

// `atS`: when the pose was true, on the clock of the frames.
void ViewpointTracker::observePose(const Pose& pose, double atS) {
  const Vec3d eyeEcefM = ecefFromGeodetic(pose.position);
  const bool first = observations_ == 0;
  if (first || pose != pose_) changedS_ = atS;
  jumped_ = jumped_ || first;
  ++observations_;
  pose_ = pose;
  eyeEcefM_ = eyeEcefM;
  observedS_ = atS;
  if (!filterRuns()) return;

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

// What is shown of a live host, and foreseen of it, is of no later moment.
double ViewpointTracker::heldS() const {
  return atS_ + carryOnS_;
}

// Where predictions start: now, but not beyond what is believed of a host that has fallen silent.
double ViewpointTracker::knownS() const {
  return live_ ? std::min(nowS_, heldS()) : nowS_;
}

double ViewpointTracker::delayS() const {
  return options_.hostDelay == HostDelayMode::fixed
             ? options_.hostDelayMs * 1e-3
             : std::clamp(jitter_.jitterS() - kForeseenJitterS, 0.0, kLongestDelayS);
}

DisplayedEye ViewpointTracker::eye() const {
  DisplayedEye eye{.pose = pose_, .silent = silent_};
  if (!live_) return eye;
  eye.jitterMs = jitter_.jitterS() * 1e3;
  eye.stampedByHost = stampedByHost_;
  if (options_.hostDelay == HostDelayMode::off) return eye;
  const double behindS = delayS(), shownS = std::min(nowS_ - behindS, heldS());
  eye.delayMs = behindS * 1e3;
  if (behindS == 0)
    eye.pose = foreseen(shownS).value_or(pose_);
  else if (const auto between = history_.at(shownS))
    eye.pose = *between;
  else
    eye.pose = carriedOn(shownS);
  return eye;
}

// By the filter; nothing where the newest pose is nearer to the truth: of an aircraft that stands, of one just heard
// of, and where the filter is wrong.
std::optional<Pose> ViewpointTracker::foreseen(double atS) const {
  // So is one that was said again before the host fell silent: placed anew, then paused.
  const bool standsStill = observedS_ - changedS_ > kStandsStillS || (silent_ && observedS_ > changedS_);
  if (standsStill || sinceRestart_ < kFewestObservations) return std::nullopt;
  const Prediction prediction = predictor_.at(atS);
  const double ageS = std::abs(atS - changedS_);
  const double offM = glm::length(prediction.ecefM - eyeEcefM_);
  if (!prediction.valid || offM > 2 * glm::length(prediction.velocityEcefMS) * ageS + kBelievableM) return std::nullopt;
  return prediction.pose;
}

// To a moment that no pose brackets. Begins at the newest pose, so that the eye goes on from where it was interpolated
// to.
Pose ViewpointTracker::carriedOn(double toS) const {
  if (history_.empty()) return pose_;
  const TrackSample& newest = history_.newest();
  if (toS <= newest.timeS) return foreseen(toS).value_or(newest.pose);  // poses too far apart
  if (motion_) return motion_(static_cast<int64_t>(toS * 1e9));
  if (!foreseen(toS)) return newest.pose;
  const Prediction from = predictor_.at(newest.timeS), to = predictor_.at(toS);
  const Geodetic position = geodeticFromEcef(ecefFromGeodetic(newest.pose.position) + to.ecefM - from.ecefM);
  const glm::dquat turn = glm::conjugate(attitudeOf(from.pose)) * attitudeOf(to.pose);
  return poseWithAttitude(position, glm::normalize(attitudeOf(newest.pose) * turn));
}

ViewpointAhead ViewpointTracker::ahead(const Vec3d& nowForwardEcef, double inS) const {
  // A silent host's eye waits, and nobody knows where it will go on.
  const Prediction prediction =
      options_.predictor == PredictorMode::none ? Prediction{} : predictor_.at(knownS() + (silent_ ? 0 : inS));
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
  if (options_.predictor == PredictorMode::none || horizonS <= 0 || silent_) return {};
  const Prediction prediction = predictor_.at(nowS_ + horizonS);
  if (!prediction.valid) return {};
  // In the order of their times: a shorter horizon than before comes behind what is still awaited.
  if (foreseen_.empty() || foreseen_.back().atS < nowS_ + horizonS)
    foreseen_.push_back({nowS_ + horizonS, prediction.ecefM});
  return {horizonS, prediction.radius98M, errorM_};
}

}  // namespace eye
