#include <algorithm>
#include <cmath>

#include "link/angles.h"
#include "link/track.h"

namespace eye {
namespace {

constexpr double kWindowS = 2;           // velocities are taken, and angles averaged, over this much on either side
constexpr double kMinCourseSpeedMS = 2;  // slower, the noise of positions turns the course: the last one is kept
constexpr double kMaxBankDeg = 60;       // a jump in a recording would otherwise roll the aircraft over
constexpr double kMaxPitchDeg = 60;
constexpr double kGravityMS2 = 9.80665;

// For sample i, the first and last sample of its window; at least its neighbours.
struct Window {
  size_t first, last;
};

std::vector<Window> windowsOf(const std::vector<TrackFix>& fixes) {
  std::vector<Window> windows(fixes.size());
  size_t first = 0, last = 0;
  for (size_t i = 0; i < fixes.size(); ++i) {
    while (fixes[i].timeS - fixes[first].timeS > kWindowS) ++first;
    while (last + 1 < fixes.size() && fixes[last + 1].timeS - fixes[i].timeS <= kWindowS) ++last;
    windows[i] = {std::min(first, i > 0 ? i - 1 : i), std::max(last, std::min(i + 1, fixes.size() - 1))};
  }
  return windows;
}

std::vector<double> averaged(const std::vector<double>& values, const std::vector<Window>& windows) {
  std::vector<double> sums(values.size() + 1, 0.0);
  for (size_t i = 0; i < values.size(); ++i) sums[i + 1] = sums[i] + values[i];
  std::vector<double> means(values.size());
  for (size_t i = 0; i < values.size(); ++i) {
    const auto [first, last] = windows[i];
    means[i] = (sums[last + 1] - sums[first]) / static_cast<double>(last + 1 - first);
  }
  return means;
}

// Change per second over each sample's window; 0 for a track of one sample.
std::vector<double> ratesOf(const std::vector<double>& values, const std::vector<TrackFix>& fixes,
                            const std::vector<Window>& windows) {
  std::vector<double> rates(values.size(), 0.0);
  for (size_t i = 0; i < values.size(); ++i) {
    const auto [first, last] = windows[i];
    if (last > first) rates[i] = (values[last] - values[first]) / (fixes[last].timeS - fixes[first].timeS);
  }
  return rates;
}

struct Motion {
  std::vector<double> headingDeg;  // unwrapped: continuous over many turns
  std::vector<double> climbDeg;
  std::vector<double> speedMS;  // over ground
};

Motion motionOf(const std::vector<TrackFix>& fixes, const std::vector<Window>& windows) {
  const size_t count = fixes.size();
  Motion motion{std::vector<double>(count), std::vector<double>(count), std::vector<double>(count)};
  size_t firstMoving = count;
  double headingDeg = 0;
  for (size_t i = 0; i < count; ++i) {
    const auto [first, last] = windows[i];
    if (last > first) {
      const double spanS = fixes[last].timeS - fixes[first].timeS;
      const Geodetic& here = fixes[i].position;
      const Vec3d wayEnuM = glm::transpose(ecefFromEnu(here.latDeg, here.lonDeg)) *
                            (ecefFromGeodetic(fixes[last].position) - ecefFromGeodetic(fixes[first].position));
      const double climbM = fixes[last].position.altM - fixes[first].position.altM;
      const double levelM = std::hypot(wayEnuM.x, wayEnuM.y);
      motion.speedMS[i] = levelM / spanS;
      if (motion.speedMS[i] >= kMinCourseSpeedMS) {
        headingDeg += wrappedDeg180(degFromRad(std::atan2(wayEnuM.x, wayEnuM.y)) - headingDeg);
        motion.climbDeg[i] = degFromRad(std::atan2(climbM, levelM));
        firstMoving = std::min(firstMoving, i);
      }
    }
    motion.headingDeg[i] = headingDeg;
  }
  // Before it first moves it already looks the way in which it will.
  for (size_t i = 0; firstMoving < count && i < firstMoving; ++i) motion.headingDeg[i] = motion.headingDeg[firstMoving];
  return motion;
}

}  // namespace

std::vector<TrackSample> withAttitude(const std::vector<TrackFix>& fixes) {
  const std::vector<Window> windows = windowsOf(fixes);
  const Motion motion = motionOf(fixes, windows);
  const std::vector<double> turnDegS = ratesOf(motion.headingDeg, fixes, windows);
  std::vector<double> bankDeg(fixes.size());
  for (size_t i = 0; i < fixes.size(); ++i) {
    const double bank = degFromRad(std::atan(motion.speedMS[i] * radFromDeg(turnDegS[i]) / kGravityMS2));
    bankDeg[i] = std::clamp(bank, -kMaxBankDeg, kMaxBankDeg);
  }
  const std::vector<double> headingDeg = averaged(motion.headingDeg, windows);
  const std::vector<double> pitchDeg = averaged(motion.climbDeg, windows);
  const std::vector<double> rollDeg = averaged(bankDeg, windows);

  std::vector<TrackSample> samples;
  samples.reserve(fixes.size());
  for (size_t i = 0; i < fixes.size(); ++i) {
    const TrackFix& fix = fixes[i];
    Pose pose{fix.position, fix.headingDeg.value_or(headingDeg[i]),
              fix.pitchDeg.value_or(std::clamp(pitchDeg[i], -kMaxPitchDeg, kMaxPitchDeg)),
              fix.rollDeg.value_or(rollDeg[i])};
    normaliseAngles(pose);
    samples.push_back({fix.timeS, pose});
  }
  return samples;
}

}  // namespace eye
