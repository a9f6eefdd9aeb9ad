// A recorded flight: samples in time, and the pose at any moment between them. Immutable once made.
#pragma once

#include <optional>
#include <vector>

#include "base/error.h"
#include "geo/pose.h"

namespace eye {

struct TrackSample {
  double timeS = 0;
  Pose pose;
};

// A sample as recordings have it: attitude may be missing, in whole or in part.
struct TrackFix {
  double timeS = 0;
  Geodetic position;
  std::optional<double> headingDeg, pitchDeg, rollDeg;
};

inline constexpr size_t kMaxTrackSamples = 1'000'000;  // 4.6 hours at 60 Hz, 11 days at 1 Hz: 56 MB

class Track {
 public:
  // The samples' times must increase strictly and there must be at least one; the first becomes time 0.
  explicit Track(std::vector<TrackSample> samples);

  double durationS() const { return samples_.back().timeS; }
  const std::vector<TrackSample>& samples() const { return samples_; }
  // At a sample's time exactly its pose; between samples continuous with its first derivative, in position (a cubic in
  // ecef, the altitude apart, so that long gaps do not cut through the Earth) and attitude. Never swings beyond its
  // samples on a straight path. Before the start and after the end it holds still.
  Pose at(double timeS) const;

 private:
  std::vector<TrackSample> samples_;
};

// Fills in what the fixes lack from the path: heading from the course, pitch from the climb angle, roll from the bank
// of a coordinated turn; all three smoothed over a few seconds. Times must increase strictly.
std::vector<TrackSample> withAttitude(const std::vector<TrackFix>& fixes);

}  // namespace eye
