#include "bench/flight_tasks.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "link/track_file.h"

namespace eye {
namespace {

constexpr double kHeightM = 2000 * 0.3048;
constexpr double kFastMS = 300, kSlowMS = 120;
constexpr double kStandardRateDegS = 3;
// 60 degrees of bank at 120 m/s: g tan(60 degrees) / v.
constexpr double kHardRateDegS = 8.1;
constexpr double kLegS = 10;         // of turns
constexpr double kSampleS = 0.1;     // of the tracks made here
constexpr double kCoverSigmaS = 4;   // of the ground's mean: climbs of seconds, not of frames
constexpr double kLeastClearM = 60;  // of a recording

// Straight on, to the right, straight on, to the left, until the time is over: it ends near the line that it began on.
FlightPlan weaving(const Spot& through, double speedMS, double turnDegS, double straightS, double durationS) {
  FlightPlan plan;
  plan.startHeadingDeg = through.headingDeg;
  plan.startSpeedMS = speedMS;
  // The spot is half way.
  const double backM = speedMS * durationS / 2, heading = radFromDeg(through.headingDeg);
  plan.start = offsetBy({through.at.latDeg, through.at.lonDeg, through.groundM}, -backM * std::sin(heading),
                        -backM * std::cos(heading));
  const std::array turnsDegS{0.0, turnDegS, 0.0, -turnDegS, 0.0, -turnDegS, 0.0, turnDegS};
  double leftS = durationS;
  for (size_t i = 0; leftS > 0; ++i) {
    const double turn = turnsDegS[i % turnsDegS.size()];
    const double legS = std::min(turn == 0 ? straightS : kLegS, leftS);
    plan.legs.push_back({legS, speedMS, turn, 0});
    leftS -= legS;
  }
  return plan;
}

Result<FlightTask> task(std::string name, int published, double ssePx, const FlightPlan& plan, GroundHeights& ground) {
  Result<Track> track = trackAboveGround(plan, kHeightM, ground);
  if (!track) return tl::unexpected(track.error());
  return FlightTask{.name = std::move(name), .published = published, .ssePx = ssePx, .track = std::move(*track)};
}

}  // namespace

Result<Track> trackAboveGround(const FlightPlan& plan, double heightM, GroundHeights& ground) {
  const FlightPath path(plan);
  // Heights under the course, one a second, from some before the start to some after the end.
  const int margin = static_cast<int>(3 * kCoverSigmaS), seconds = static_cast<int>(std::ceil(path.durationS()));
  std::vector<double> groundM;
  for (int s = -margin; s <= seconds + margin; ++s) {
    const Geodetic at = path.positionAt(std::clamp<double>(s, 0, path.durationS()));
    const Result<double> height = ground.heightM({at.latDeg, at.lonDeg});
    if (!height) return tl::unexpected(height.error());
    groundM.push_back(*height);
  }
  std::vector<double> coverM = groundM;
  for (size_t i = 1; i + 1 < groundM.size(); ++i) coverM[i] = std::max({groundM[i - 1], groundM[i], groundM[i + 1]});
  const auto positionAt = [&](double timeS) {
    double weights = 0, sumM = 0;
    for (size_t i = 0; i < coverM.size(); ++i) {
      const double apart = (static_cast<double>(i) - margin - timeS) / kCoverSigmaS;
      const double weight = std::exp(-0.5 * apart * apart);
      weights += weight;
      sumM += weight * coverM[i];
    }
    Geodetic position = path.positionAt(timeS);
    position.altM = heightM + sumM / weights;
    return position;
  };
  std::vector<TrackSample> samples;
  const auto count = static_cast<int>(std::floor(path.durationS() / kSampleS + 1e-9));
  for (int i = 0; i <= count; ++i)
    samples.push_back({i * kSampleS, poseAlongPath(positionAt, i * kSampleS, plan.startHeadingDeg)});
  return Track(std::move(samples));
}

Result<std::vector<FlightTask>> builtInTasks(const Place& mountains, GroundHeights& ground, double durationS) {
  const Spot& spot = mountains.spots[1];  // half way up
  std::vector<FlightTask> tasks;
  for (Result<FlightTask> made :
       {task("high-resolution low-level", 1, 0.5, weaving(spot, kFastMS, kStandardRateDegS, 10, durationS), ground),
        task("mountains 300 m/s", 2, 1, weaving(spot, kFastMS, kStandardRateDegS, 6, durationS), ground),
        task("mountains 120 m/s, hard turns", 3, 1, weaving(spot, kSlowMS, kHardRateDegS, 2, durationS), ground)}) {
    if (!made) return tl::unexpected(made.error());
    tasks.push_back(std::move(*made));
  }
  return tasks;
}

Track middleOf(const Track& track, double durationS) {
  if (track.durationS() <= durationS) return track;
  const double beginS = (track.durationS() - durationS) / 2, endS = beginS + durationS;
  std::vector<TrackSample> samples{{beginS, track.at(beginS)}};
  for (const TrackSample& sample : track.samples())
    if (sample.timeS > beginS && sample.timeS < endS) samples.push_back(sample);
  samples.push_back({endS, track.at(endS)});
  return Track(std::move(samples));
}

bool isWithin(const Track& track, const TileBounds& bounds) {
  return std::ranges::all_of(track.samples(), [&](const TrackSample& sample) {
    const Geodetic& at = sample.pose.position;
    return at.latDeg >= bounds.southDeg && at.latDeg <= bounds.northDeg && at.lonDeg >= bounds.westDeg &&
           at.lonDeg <= bounds.eastDeg;
  });
}

Track movedTo(const Track& track, const LatLon& to) {
  const Geodetic from = track.samples()[track.samples().size() / 2].pose.position;
  const Vec3d originM = ecefFromGeodetic({from.latDeg, from.lonDeg, 0});
  const Vec3d newOriginM = ecefFromGeodetic({to.latDeg, to.lonDeg, 0});
  // East, north and up of the one place become those of the other; the Earth's curvature is nearly the same.
  const Mat3d turn = ecefFromEnu(to.latDeg, to.lonDeg) * glm::transpose(ecefFromEnu(from.latDeg, from.lonDeg));
  std::vector<TrackSample> samples = track.samples();
  for (TrackSample& sample : samples) {
    const double altM = sample.pose.position.altM;
    sample.pose.position = geodeticFromEcef(newOriginM + turn * (ecefFromGeodetic(sample.pose.position) - originM));
    sample.pose.position.altM = altM;
  }
  return Track(std::move(samples));
}

Result<FlightTask> recordedTask(const std::string& path, const TileBounds& bounds, GroundHeights& ground,
                                double durationS) {
  const Result<Track> recorded = loadTrack(path);
  if (!recorded) return tl::unexpected(recorded.error());
  FlightTask task{.name = path.substr(path.find_last_of('/') + 1), .track = middleOf(*recorded, durationS)};
  task.isMoved = !isWithin(task.track, bounds);
  if (task.isMoved)
    task.track = movedTo(task.track, {(bounds.southDeg + bounds.northDeg) / 2, (bounds.westDeg + bounds.eastDeg) / 2});
  for (double timeS = 0; timeS <= task.track.durationS(); timeS += 1) {
    const Geodetic at = task.track.at(timeS).position;
    const Result<double> groundM = ground.heightM({at.latDeg, at.lonDeg});
    if (!groundM) return tl::unexpected(groundM.error());
    task.raisedM = std::max(task.raisedM, *groundM + kLeastClearM - at.altM);
  }
  if (task.raisedM > 0) {
    std::vector<TrackSample> samples = task.track.samples();
    for (TrackSample& sample : samples) sample.pose.position.altM += task.raisedM;
    task.track = Track(std::move(samples));
  }
  return task;
}

}  // namespace eye
