// What a host's poses say of the time between them.
#include "link/pose_history.h"

#include <catch2/catch.hpp>

#include "geo/frames.h"
#include "link/angles.h"
#include "link/flight_plan.h"

namespace eye {
namespace {

double metresBetween(const Geodetic& a, const Geodetic& b) {
  return glm::distance(ecefFromGeodetic(a), ecefFromGeodetic(b));
}

TEST_CASE("pose history: between poses of a turning flight the aircraft is where it was, and turned as it was") {
  FlightPlan plan;
  plan.start = {49.2, 179.999, 3000};  // across the date line
  plan.startHeadingDeg = 80, plan.startSpeedMS = 150;
  plan.legs = {{5, 150, 3, 5}, {10, 150, -4, -5}};
  const FlightPath path(plan);
  PoseHistory history;
  for (int i = 0; i < 30; ++i) {
    const double atS = 2 + (i ^ 1) / 20.0;  // 20 Hz, each pair in the wrong order
    history.add(100 + atS, path.poseAt(atS));
  }
  for (double t = 2.6; t < 3.4; t += 0.007) {
    const auto shown = history.at(100 + t);
    REQUIRE(shown);
    const Pose truth = path.poseAt(t);
    CHECK(metresBetween(shown->position, truth.position) < 0.02);
    const Mat3d is = ecefFromBody(*shown), was = ecefFromBody(truth);
    CHECK(glm::distance(is[0], was[0]) < 2e-3);
    CHECK(glm::distance(is[1], was[1]) < 2e-3);
  }
  CHECK_FALSE(history.at(104));
  CHECK(history.at(100 + 3.2) == path.poseAt(3.2));
}

TEST_CASE(
    "pose history: along the ground and the short way round, across the pole too; none in a gap, none in a jump") {
  PoseHistory history;
  CHECK_FALSE(history.at(0));
  history.add(0, {{89.9995, 10, 1000}, 350, 0, 170});
  history.add(0.4, {{89.9995, -170, 1000}, 170, 0, -170});  // the same course over the pole
  const auto pole = history.at(0.2);
  REQUIRE(pole);
  CHECK(pole->position.latDeg > 89.99999);
  CHECK(pole->position.altM == Approx(1000).margin(1e-6));
  CHECK(history.at(-3)->position.lonDeg == 10);  // before the oldest
  history.clear();
  history.add(0, {{10, 20, 1000}, 355, 0, 0});
  history.add(0.1, {{10.0001, 20, 1000}, 5, 0, 0});
  const double headingDeg = history.at(0.05)->headingDeg;
  CHECK((headingDeg < 1e-6 || headingDeg > 360 - 1e-6));
  history.add(0.7, {{10.0002, 20, 1000}, 5, 0, 0});
  CHECK_FALSE(history.at(0.4));
  history.add(0.8, {{11, 20, 1000}, 5, 0, 0});
  CHECK(history.at(0.79)->position.latDeg == 10.0002);
  CHECK(history.at(0.8)->position.latDeg == 11);
  // Bounded: a second, and 256 poses.
  for (int i = 0; i < 10'000; ++i) history.add(2 + i * 1e-4, {{12, 20, 1000.0 + i}, 0, 0, 0});
  CHECK(history.at(0)->position.altM >= 1000 + 10'000 - 256);
}

}  // namespace
}  // namespace eye
