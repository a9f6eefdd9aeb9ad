// The viewpoint over time: what the pager looks ahead along, and how good the prediction has been. Owner thread:
// render.
#pragma once

#include <deque>
#include <optional>

#include "app/options.h"
#include "geo/view.h"
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
  double delayMs = 0;   // behind the frame's time
  bool silent = false;  // the host has said nothing for so long that the eye waits where it was last foreseen
};

// Where a channel looks from the aircraft's eye: --view-offset.
Pose channelPose(const Pose& aircraft, const Options& options);

class ViewpointTracker {
 public:
  // The options must live longer.
  explicit ViewpointTracker(const Options& options);

  // Once a frame. `nowS`: a clock that never goes back; for a live host the one that arrival times are on.
  void observe(const SourceSample& host, const Pose& pose, double nowS);
  // Where a live host's aircraft is at the frame's time, or a little before it (--host-delay): packets come neither
  // when frames do nor evenly, and an eye that is put where the newest one says stutters. Otherwise the pose observed.
  DisplayedEye eye() const;
  // From the view of this frame on. Valid until the next observe().
  LookAhead lookAhead(const View& view) const;
  // What the statistics say of predictions `horizonS` ahead.
  PredictionRecord record(double horizonS);

 private:
  ViewpointAhead ahead(const Vec3d& nowForwardEcef, double inS) const;

  void observePose(const Pose& pose, double atS);
  double knownS() const;
  bool isSilent() const;

  const Options& options_;
  ViewpointPredictor predictor_;
  JitterMeter jitter_;
  double nowS_ = 0, frameRateHz_ = 60;
  int frames_ = 0, observations_ = 0;
  bool live_ = false, jumped_ = false;
  // Of the newest observation.
  Pose pose_;
  Vec3d eyeEcefM_{};
  int64_t arrivedNs_ = 0;
  double observedS_ = 0, changedS_ = 0;  // when it came; when the pose was another one last
  double speedMS_ = 0;                   // mean
  uint64_t restarts_ = 0;                // of the predictor
  int sinceRestart_ = 0;                 // observations
  struct Foreseen {
    double atS;
    Vec3d ecefM;
  };
  std::deque<Foreseen> foreseen_;
  std::optional<double> errorM_;
};

}  // namespace eye
