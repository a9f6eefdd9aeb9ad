// The viewpoint over time: what the pager looks ahead along, and how good the prediction has been. Owner thread:
// render.
#pragma once

#include <deque>
#include <optional>

#include "app/options.h"
#include "geo/view.h"
#include "link/pose_history.h"
#include "link/state_source.h"
#include "paging/schedule.h"
#include "predict/jitter_meter.h"
#include "predict/viewpoint_predictor.h"

namespace eye {

// Of the viewpoint after the time that the pager looks ahead.
struct PredictionRecord {
  double horizonS = 0;
  double radiusM = 0;            // 98 %
  std::optional<double> errorM;  // of the newest prediction whose time has come
};

// The eye of a frame.
struct DisplayedEye {
  Pose pose;
  double delayMs = 0;          // behind the frame's time
  double jitterMs = 0;         // of a live host's packets, by which the delay is chosen
  bool silent = false;         // the host has said nothing for so long that the eye waits where it was last foreseen
  bool stampedByHost = false;  // the times of the poses are the host's, else those of arrival
};

// Where a channel looks from the aircraft's eye: --view-offset.
Pose channelPose(const Pose& aircraft, const Options& options);

class ViewpointTracker {
 public:
  // The options must live longer.
  explicit ViewpointTracker(const Options& options);

  // Once a frame. `nowS`: a clock that never goes back; for a live host the one that its times are on.
  void observe(const SourceSample& host, const Pose& pose, double nowS);
  // Where a live host's aircraft is at the frame's time, or a little before it (--host-delay): packets come neither
  // when frames do nor evenly, and an eye that is put where the newest one says stutters. Otherwise the pose observed.
  // At moments that lie between poses it is interpolated between them; beyond the newest one it is carried on, by the
  // host's own rates or by the filter.
  DisplayedEye eye() const;
  // From the view of this frame on. Valid until the next observe().
  LookAhead lookAhead(const View& view) const;
  // What the statistics say of predictions `horizonS` ahead.
  PredictionRecord record(double horizonS);

 private:
  ViewpointAhead ahead(const Vec3d& nowForwardEcef, double inS) const;

  void hear(const StampedPose& heard);
  void observePose(const Pose& pose, double atS);
  void measureSpeed(double atS);
  double momentOf(const StampedPose& heard) const;
  double delayS() const;
  double heldS() const;
  double knownS() const;
  bool filterRuns() const { return live_ || options_.predictor != PredictorMode::none; }
  std::optional<Pose> foreseen(double atS) const;
  Pose carriedOn(double toS) const;

  const Options& options_;
  ViewpointPredictor predictor_;
  JitterMeter jitter_;
  PoseHistory history_;  // of a live host
  double nowS_ = 0, frameRateHz_ = 60;
  int frames_ = 0, observations_ = 0;
  bool live_ = false, silent_ = false, jumped_ = false;
  // Of the newest observation.
  Pose pose_;
  Vec3d eyeEcefM_{};
  double observedS_ = 0, changedS_ = 0;  // when it was true; when the pose was another one last
  // Of a live host, from its sample: see there.
  double atS_ = 0, carryOnS_ = 0;
  bool stampedByHost_ = false;
  std::function<Pose(int64_t)> motion_;
  double speedMS_ = 0;               // mean
  int speeds_ = 0;                   // in it
  std::optional<double> measuredS_;  // where the next one is measured from
  Vec3d measuredEcefM_{};
  uint64_t restarts_ = 0;  // of the predictor
  int sinceRestart_ = 0;   // observations
  struct Foreseen {
    double atS;
    Vec3d ecefM;
  };
  std::deque<Foreseen> foreseen_;
  std::optional<double> errorM_;
};

}  // namespace eye
