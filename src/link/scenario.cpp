#include "link/scenario.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geo/demo_site.h"
#include "link/flight_plan.h"

namespace eye {
namespace {

constexpr Geodetic kSite = {kDemoRunwayLatDeg, kDemoRunwayLonDeg, kDemoRunwayElevationM};
constexpr double kCockpitM = 4;  // the eye above the runway while the wheels are on it
constexpr double kOnRunwayM = kDemoRunwayElevationM + kCockpitM;

Geodetic placeAt(double eastM, double northM, double altM) {
  Geodetic place = offsetBy(kSite, eastM, northM);
  place.altM = altM;
  return place;
}

// Legs: seconds, speed at the end (m/s), turn (degrees/s, clockwise), climb (m/s).

const FlightPath& tour() {
  static const FlightPath path(
      {placeAt(-1350, 0, kOnRunwayM),
       kDemoRunwayHeadingDeg,
       0,
       {{16, 95, 0, 0}, {6, 125, 0, 12}, {38, 210, -2.0, 10}, {14, 225, 0, 32}, {16, 225, 2.2, 8}}});
  return path;
}

const FlightPath& takeoff() {
  static const FlightPath path({placeAt(-1350, 0, kOnRunwayM),
                                kDemoRunwayHeadingDeg,
                                0,
                                {{30, 75, 0, 0}, {15, 85, 0, 8}, {15, 95, 0, 12}, {15, 95, -2, 12}}});
  return path;
}

// Low over the northern basin, up the wall of the mountains, over their ridge of 2,000 m and down to the airfield.
const FlightPath& lowLevel() {
  static const FlightPath path({placeAt(-2'000, 28'000, 300),
                                235,
                                170,
                                {{28, 170, 0, 0},
                                 {12, 170, 0, 40},
                                 {22, 170, -2.2, 42},
                                 {26, 165, 0, 24},
                                 {30, 160, -0.3, -10},
                                 {10, 165, -2, -30},
                                 {34, 175, 0, -40}}});
  return path;
}

// Three degrees of glide, a flare, and the roll-out to walking pace.
const FlightPath& approach() {
  constexpr double kGlideS = 100, kFlareS = 8, kSinkMS = 3.85, kFlareSinkMS = 0.9;
  constexpr double kTouchdownEastM = -1200;  // 300 m behind the threshold
  constexpr double kGlideM = kGlideS * (75 + 72) / 2, kFlareM = kFlareS * (72 + 66) / 2;
  static const FlightPath path(
      {placeAt(kTouchdownEastM - kGlideM - kFlareM, 0, kOnRunwayM + kGlideS * kSinkMS + kFlareS * kFlareSinkMS),
       kDemoRunwayHeadingDeg,
       75,
       {{kGlideS, 72, 0, -kSinkMS}, {kFlareS, 66, 0, -kFlareSinkMS}, {22, 8, 0, 0}}});
  return path;
}

constexpr double kOrbitRadiusM = 6000, kOrbitSpeedMS = 150, kOrbitAltM = 900;
constexpr double kOrbitS = 2 * std::numbers::pi * kOrbitRadiusM / kOrbitSpeedMS;  // one turn: it can be looped

Pose orbitAt(double timeS) {
  const auto positionAt = [](double t) {
    const double angle = 2 * std::numbers::pi * t / kOrbitS;  // clockwise from north
    return placeAt(kOrbitRadiusM * std::sin(angle), kOrbitRadiusM * std::cos(angle), kOrbitAltM);
  };
  return poseAlongPath(positionAt, std::clamp(timeS, 0.0, kOrbitS), 0);
}

// 0 to 1 with two continuous derivatives at both ends.
double smootherStep(double u) {
  return u * u * u * (u * (6 * u - 15) + 10);
}

// From the farthest of paper 004's five views down to the runway, where the eye stops at a child's height.
constexpr double kDescentS = 120, kDescentFromM = 62'763'000, kDescentToM = 2;

// Straight down. The height above the runway falls by the same factor each second but for a soft start and end, so that
// the ground comes nearer evenly; the view rises to the horizon and turns along the runway.
Pose descentAt(double timeS) {
  const double u = smootherStep(std::clamp(timeS / kDescentS, 0.0, 1.0));
  const double heightM = kDescentFromM * std::pow(kDescentToM / kDescentFromM, u);
  constexpr double kStartOfRunwayM = -1350;
  return {placeAt(kStartOfRunwayM, 0, kDemoRunwayElevationM + heightM), kDemoRunwayHeadingDeg * u, -90 * (1 - u), 0};
}

}  // namespace

const std::vector<Scenario>& scenarios() {
  static const std::vector<Scenario> all = {
      {"takeoff", "take-off to the east and a climb with a left turn", takeoff().durationS(),
       [](double t) { return takeoff().poseAt(t); }},
      {"low-level", "a jet over the mountains, turn after turn", lowLevel().durationS(),
       [](double t) { return lowLevel().poseAt(t); }},
      {"orbit", "one turn around the airfield, 6 km out", kOrbitS, orbitAt},
      {"approach", "three degrees down to the runway, flare and roll-out", approach().durationS(),
       [](double t) { return approach().poseAt(t); }},
      {"descent-from-space", "from 62,763 km straight down to 2 m above the runway", kDescentS, descentAt},
      {kDefaultScenario, "take-off, climb and a low-level turn: what demo:// flies", tour().durationS(),
       [](double t) { return tour().poseAt(t); }},
  };
  return all;
}

Result<Scenario> findScenario(const std::string& name) {
  std::string names;
  for (const Scenario& scenario : scenarios()) {
    if (scenario.name == name) return scenario;
    names += (names.empty() ? "" : ", ") + scenario.name;
  }
  return fail(ErrorKind::usage, fmt::format("there is no scenario '{}'; there are: {}", name, names));
}

}  // namespace eye
