#include "bench/selector_flight.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace eye {
namespace {

struct HeightKey {
  double timeS, heightM;
};
// Low for two minutes, up to 10 km, down again to an approach: between the keys heights change by equal ratios.
constexpr std::array kHeights{HeightKey{0, 30},     HeightKey{60, 30},    HeightKey{90, 150},    HeightKey{130, 300},
                              HeightKey{160, 1000}, HeightKey{190, 3000}, HeightKey{220, 10000}, HeightKey{240, 10000},
                              HeightKey{270, 1200}, HeightKey{285, 200},  HeightKey{300, 60}};
// A figure of eight of 10 km, at 100 to 210 m/s.
constexpr double kLoopS = 180, kReachM = 5000, kWidthM = 2500;
constexpr double kMetresPerDeg = 111200;
constexpr double kStepS = 1;
// The ground counts from so long before to so long after: hills are flown over, not into.
constexpr int kAheadSteps = 4;
constexpr double kLeastClearanceM = 20;

LatLon placeAt(const Spot& spot, double timeS) {
  const double phase = 2 * std::numbers::pi * timeS / kLoopS;
  const double alongM = kReachM * std::sin(phase), acrossM = kWidthM * std::sin(2 * phase);
  const double heading = radFromDeg(spot.headingDeg);
  const double northM = alongM * std::cos(heading) - acrossM * std::sin(heading);
  const double eastM = alongM * std::sin(heading) + acrossM * std::cos(heading);
  return {spot.at.latDeg + northM / kMetresPerDeg,
          spot.at.lonDeg + eastM / (kMetresPerDeg * std::cos(radFromDeg(spot.at.latDeg)))};
}

// Nose up and down by turns, from -20 to 12 degrees; two periods that never meet.
double pitchAt(double timeS) {
  return -4 + 9 * std::sin(2 * std::numbers::pi * timeS / 47) + 7 * std::sin(2 * std::numbers::pi * timeS / 19);
}

Result<Track> flyRound(const Spot& spot, GroundHeights& ground) {
  std::vector<LatLon> path;
  std::vector<double> groundM;
  for (int step = -kAheadSteps; step <= static_cast<int>(kFlightHalfS / kStepS) + kAheadSteps; ++step) {
    path.push_back(placeAt(spot, step * kStepS));
    const Result<double> heightM = ground.heightM(path.back());
    if (!heightM) return tl::unexpected(heightM.error());
    groundM.push_back(*heightM);
  }
  std::vector<TrackFix> fixes;
  for (size_t i = kAheadSteps; i + kAheadSteps < path.size(); ++i) {
    const double timeS = static_cast<double>(i - kAheadSteps) * kStepS;
    // The mean round about, but never below what is near.
    double meanM = 0, highestM = -1e9;
    for (size_t k = i - kAheadSteps; k <= i + kAheadSteps; ++k) meanM += groundM[k] / (2 * kAheadSteps + 1);
    for (size_t k = i - 1; k <= i + 1; ++k) highestM = std::max(highestM, groundM[k]);
    const double altM = std::max(meanM + flightHeightM(timeS), highestM + kLeastClearanceM);
    fixes.push_back({timeS, {path[i].latDeg, path[i].lonDeg, altM}, {}, pitchAt(timeS), {}});
  }
  return Track(withAttitude(fixes));
}

}  // namespace

double flightHeightM(double halfS) {
  if (halfS <= kHeights.front().timeS) return kHeights.front().heightM;
  for (size_t i = 1; i < kHeights.size(); ++i) {
    const HeightKey &from = kHeights[i - 1], &to = kHeights[i];
    if (halfS > to.timeS) continue;
    const double share = (halfS - from.timeS) / (to.timeS - from.timeS);
    return from.heightM * std::pow(to.heightM / from.heightM, share);
  }
  return kHeights.back().heightM;
}

Pose SelectorFlight::at(double timeS) const {
  return timeS < kFlightHalfS ? halves[0].at(timeS) : halves[1].at(timeS - kFlightHalfS);
}

Result<SelectorFlight> makeSelectorFlight(const std::array<Place, 2>& places, GroundHeights& ground) {
  Result<Track> plain = flyRound(places[0].spots[0], ground);
  if (!plain) return tl::unexpected(plain.error());
  Result<Track> mountains = flyRound(places[1].spots[0], ground);
  if (!mountains) return tl::unexpected(mountains.error());
  return SelectorFlight{{std::move(*plain), std::move(*mountains)}};
}

}  // namespace eye
