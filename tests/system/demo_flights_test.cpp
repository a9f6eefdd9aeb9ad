// The built-in flights against the demo's ground: low where they should be, never in it.
#include <algorithm>
#include <catch2/catch.hpp>

#include "bake/demo_terrain.h"
#include "link/scenario.h"

namespace eye {
namespace {

TEST_CASE("demo flights keep clear of the demo's ground") {
  for (const Scenario& scenario : scenarios()) {
    INFO(scenario.name);
    double lowestM = 1e9;
    for (double t = 0; t <= scenario.durationS; t += 0.25) {
      const Geodetic at = scenario.poseAt(t).position;
      lowestM = std::min(lowestM, at.altM - demoHeightM(at.latDeg, at.lonDeg, 100));
    }
    const bool onRunway = scenario.name == "takeoff" || scenario.name == "approach" || scenario.name == "tour";
    CHECK(lowestM > (scenario.name == "descent-from-space" ? 1.9 : onRunway ? 3.9 : 60));
    CHECK(lowestM < (scenario.name == "low-level" ? 150 : 3000));
  }
}

}  // namespace
}  // namespace eye
