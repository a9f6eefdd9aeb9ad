#include "link/scenario.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "geo/demo_site.h"
#include "geo/frames.h"
#include "link/angles.h"

namespace eye {
namespace {

double angleBetweenDeg(const Pose& a, const Pose& b) {
  const Mat3d turn = glm::transpose(ecefFromBody(a)) * ecefFromBody(b);
  return degFromRad(std::acos(std::min(1.0, (turn[0][0] + turn[1][1] + turn[2][2] - 1) / 2)));
}

// Metres per second; the descent from space falls by a share of its height instead.
double speedBoundMS(const Scenario& scenario, const Pose& pose) {
  return scenario.name == "descent-from-space" ? 0.3 * pose.position.altM : 240;
}

TEST_CASE("every scenario is smooth, plausible, and never below the runway") {
  constexpr double kFrameS = 1.0 / 60;
  for (const Scenario& scenario : scenarios()) {
    INFO(scenario.name);
    Pose before = scenario.poseAt(0);
    double beforeTurnDeg = angleBetweenDeg(before, scenario.poseAt(kFrameS));
    for (double t = kFrameS; t <= scenario.durationS; t += kFrameS) {
      INFO("at " << t << " s");
      const Pose now = scenario.poseAt(t);
      const double wayM = glm::length(ecefFromGeodetic(now.position) - ecefFromGeodetic(before.position));
      REQUIRE(wayM <= speedBoundMS(scenario, before) * kFrameS);
      const double turnDeg = angleBetweenDeg(before, now);
      REQUIRE(turnDeg < 20 * kFrameS);                    // 20 degrees/s, a jet's roll
      REQUIRE(std::abs(turnDeg - beforeTurnDeg) < 0.01);  // no kink
      REQUIRE(std::abs(now.rollDeg) < 46);
      REQUIRE(now.position.altM >= kDemoRunwayElevationM + (scenario.name == "descent-from-space" ? 1.999 : 3.9));
      REQUIRE((now.position.latDeg > kDemoSouthDeg && now.position.latDeg < kDemoNorthDeg));
      REQUIRE((now.position.lonDeg > kDemoWestDeg && now.position.lonDeg < kDemoEastDeg));
      before = now;
      beforeTurnDeg = turnDeg;
    }
    // Held at both ends.
    CHECK(scenario.poseAt(-1) == scenario.poseAt(0));
    CHECK(scenario.poseAt(scenario.durationS + 100) == scenario.poseAt(scenario.durationS));
  }
}

TEST_CASE("scenarios are the ones that are promised") {
  for (const char* name : {"takeoff", "low-level", "orbit", "approach", "descent-from-space", "tour"})
    CHECK(findScenario(name));
  const auto none = findScenario("loop");
  REQUIRE_FALSE(none);
  CHECK(exitStatus(none.error()) == 2);
  CHECK(none.error().message.find("descent-from-space") != std::string::npos);
  CHECK(findScenario(kDefaultScenario)->durationS == Approx(90));
}

TEST_CASE("take-off begins and approach ends on the runway, along it") {
  const double halfRunwayDeg = kDemoRunwayLengthM / 2 / (111'320 * std::cos(radFromDeg(kDemoRunwayLatDeg)));
  const auto onRunway = [&](const Pose& pose) {
    return std::abs(pose.position.lonDeg - kDemoRunwayLonDeg) < halfRunwayDeg &&
           std::abs(pose.position.latDeg - kDemoRunwayLatDeg) < kDemoRunwayWidthM / 2 / 111'000 &&
           std::abs(pose.headingDeg - kDemoRunwayHeadingDeg) < 0.5 &&
           std::abs(pose.position.altM - kDemoRunwayElevationM - 4) < 0.1;
  };
  const auto takeoff = findScenario("takeoff"), approach = findScenario("approach"), tour = findScenario("tour");
  for (double t = 0; t < 25; t += 0.5) CHECK(onRunway(takeoff->poseAt(t)));
  for (double t = 0; t < 11; t += 0.5) CHECK(onRunway(tour->poseAt(t)));
  for (double t = 113; t < approach->durationS; t += 0.5) CHECK(onRunway(approach->poseAt(t)));
  const Pose glide = approach->poseAt(50);
  CHECK(glide.pitchDeg == Approx(-3).margin(0.1));
}

TEST_CASE("descent-from-space comes down from 62,763 km to 2 m and never rises") {
  const auto descent = findScenario("descent-from-space");
  CHECK(descent->poseAt(0).position.altM - kDemoRunwayElevationM == Approx(62'763'000));
  CHECK(descent->poseAt(0).pitchDeg == Approx(-90));
  const Pose end = descent->poseAt(descent->durationS);
  CHECK(end.position.altM - kDemoRunwayElevationM == Approx(2));
  CHECK(end.pitchDeg == Approx(0).margin(1e-9));
  CHECK(end.headingDeg == Approx(kDemoRunwayHeadingDeg));
  double beforeM = 1e9;
  for (double t = 0; t <= descent->durationS; t += 1.0 / 60) {
    const double altM = descent->poseAt(t).position.altM;
    REQUIRE(altM <= beforeM);
    beforeM = altM;
  }
}

TEST_CASE("orbit can be looped") {
  const auto orbit = findScenario("orbit");
  const Pose a = orbit->poseAt(0), b = orbit->poseAt(orbit->durationS);
  CHECK(glm::length(ecefFromGeodetic(a.position) - ecefFromGeodetic(b.position)) < 0.01);
  CHECK(angleBetweenDeg(a, b) < 0.01);
}

}  // namespace
}  // namespace eye
