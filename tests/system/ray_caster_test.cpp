// The ray caster against what can be worked out without it.
#include "truth/ray_caster.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

namespace eye::truth {
namespace {

constexpr double kConeLatDeg = 49.5, kConeLonDeg = 20.5;
constexpr GridShape kOneDegree{49, 20, 1.0 / 1200, 1201, 1201};

// 2,000 m high, 20 km in radius (in metres on the local map), on a plain at 100 m.
double coneM(double latDeg, double lonDeg) {
  const double northM = (latDeg - kConeLatDeg) * 111220, eastM = (lonDeg - kConeLonDeg) * 72460;
  return std::max(100.0, 2100 - std::hypot(northM, eastM) / 10);
}

// The clearance over a surface given as a function, without grid, pyramid or skipping.
template <class Height>
double firstHitM(Vec eye, Vec direction, double stepM, double endM, const Height& heightM) {
  const auto clearance = [&](double t) {
    const Place p = frameAt(eye + t * direction).place;
    return p.altM - heightM(p.latDeg, p.lonDeg);
  };
  for (double t = 0; t < endM; t += stepM) {
    if (clearance(t + stepM) > 0) continue;
    double a = t, b = t + stepM;
    for (int i = 0; i < 60; ++i) (clearance((a + b) / 2) > 0 ? a : b) = (a + b) / 2;
    return b;
  }
  return -1;
}

Vec directionFrom(const EyePose& pose) {
  return axesOf(pose).forward;
}

}  // namespace

TEST_CASE("own geodesy: there and back, and known points") {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> lat(-90, 90), lon(-180, 180), alt(-5000, 500000);
  for (int i = 0; i < 20000; ++i) {
    const Place p{lat(random), lon(random), alt(random)};
    const Vec ecef = ecefFromPlace(p);
    const Place back = frameAt(ecef).place;
    REQUIRE(length(ecefFromPlace(back) - ecef) < 1e-6);
    REQUIRE(std::abs(back.altM - p.altM) < 1e-6);
  }
  const Vec pole = ecefFromPlace({90, 0, 0});
  CHECK(std::abs(pole.z - 6356752.314245) < 1e-6);
  CHECK(length(ecefFromPlace({0, 0, 10}) - Vec{6378147, 0, 0}) < 1e-6);
  // Metres a degree at 45 N, from the tables of the ellipsoid: 111,131.7 and 78,846.8.
  const LocalFrame middle = frameAt(ecefFromPlace({45, 7, 0}));
  CHECK(middle.metresPerDegLat == Approx(111131.7).margin(0.5));
  CHECK(middle.metresPerDegLon == Approx(78846.8).margin(0.5));
}

TEST_CASE("own attitude: heading, pitch and roll turn the way the contract says") {
  const LocalFrame local = frameAt(ecefFromPlace({49, 20, 1000}));
  const EyePose east{{49, 20, 1000}, 90, 0, 0};
  CHECK(dot(axesOf(east).forward, local.east) == Approx(1));
  CHECK(dot(axesOf({{49, 20, 1000}, 0, 30, 0}).forward, local.up) == Approx(0.5));
  CHECK(dot(axesOf({{49, 20, 1000}, 0, 0, 30}).right, local.up) == Approx(-0.5));  // right wing down
  CHECK(dot(axesOf({{49, 20, 1000}, 0, 0, 30}).up, local.east) == Approx(0.5));
}

TEST_CASE("rays on a plain: straight down exactly, slanted as a march finds it") {
  const HeightGrid plain(kOneDegree, [](double, double) { return 100.0; });
  const Vec eye = ecefFromPlace({49.5, 20.5, 3100});
  const Hit down = castRay(plain, eye, directionFrom({{49.5, 20.5, 3100}, 0, -90, 0}));
  REQUIRE(down.kind == HitKind::terrain);
  CHECK(down.distanceM == Approx(3000).margin(1e-3));
  for (const double pitch : {-60.0, -30.0, -10.0, -6.0}) {
    const Vec direction = directionFrom({{49.5, 20.5, 3100}, 77, pitch, 0});
    const Hit hit = castRay(plain, eye, direction);
    REQUIRE(hit.kind == HitKind::terrain);
    CHECK(hit.distanceM ==
          Approx(firstHitM(eye, direction, 100, 60000, [](double, double) { return 100.0; })).margin(1e-3));
  }
  CHECK(castRay(plain, eye, directionFrom({{49.5, 20.5, 3100}, 77, 0, 0})).kind == HitKind::sky);
  // Past the border low down the bake fades from 100 m to the sea: nobody can say; from high up the sea is met beyond.
  CHECK(castRay(plain, eye, directionFrom({{49.5, 20.5, 3100}, 0, -3.29, 0})).kind == HitKind::unknown);
  const Vec high = ecefFromPlace({49.5, 20.5, 60000});
  const Vec outwards = directionFrom({{49.5, 20.5, 60000}, 0, -30, 0});
  const Hit sea = castRay(plain, high, outwards);
  REQUIRE(sea.kind == HitKind::terrain);
  CHECK(sea.distanceM ==
        Approx(firstHitM(high, outwards, 1000, 200000, [](double, double) { return 0.0; })).margin(1e-2));
}

TEST_CASE("rays on a cone: the analytic cone, within what bilinear posts make of it") {
  const HeightGrid grid(kOneDegree, coneM);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> offset(-0.2, 0.2), heading(0, 360), pitch(-40, 2);
  int terrain = 0;
  for (int i = 0; i < 400; ++i) {
    const Place place{kConeLatDeg + offset(random), kConeLonDeg + offset(random), 2300};
    const EyePose pose{place, heading(random), pitch(random), 0};
    const Vec eye = ecefFromPlace(place), direction = directionFrom(pose);
    const Hit hit = castRay(grid, eye, direction);
    const Place at = frameAt(eye + hit.distanceM * direction).place;
    if (hit.kind == HitKind::unknown || std::abs(at.latDeg - 49.5) > 0.5 || std::abs(at.lonDeg - 20.5) > 0.5) continue;
    const auto onGrid = [&](double lat, double lon) { return grid.heightM(grid.rowOf(lat), grid.columnOf(lon)); };
    // The march on the very same grid: to the millimetre, whatever was skipped.
    const double sameM = firstHitM(eye, direction, 20, 80000, onGrid);
    REQUIRE((hit.kind == HitKind::terrain) == (sameM >= 0));
    if (hit.kind != HitKind::terrain) continue;
    ++terrain;
    REQUIRE(hit.distanceM == Approx(sameM).margin(1.5e-3));
    // And the cone itself: bilinear posts 93 m apart miss it by at most 10 m at the apex, by less on its sides.
    REQUIRE(std::abs(at.altM - coneM(at.latDeg, at.lonDeg)) < 10);
  }
  CHECK(terrain > 150);
}

TEST_CASE("a spike one post wide is met and never skipped over") {
  const HeightGrid grid(kOneDegree, [](double lat, double lon) {
    return std::abs(lat - 49.6) < 1e-6 && std::abs(lon - 20.5) < 1e-6 ? 1000.0 : 0.0;
  });
  const Place place{49.3, 20.5, 900};
  const Vec eye = ecefFromPlace(place), spike = ecefFromPlace({49.6, 20.5, 900});
  const Hit hit = castRay(grid, eye, spike - eye);
  REQUIRE(hit.kind == HitKind::terrain);
  CHECK(hit.distanceM == Approx(length(spike - eye)).margin(20));  // its southern slope: 92.7 m for 1,000 m of height
  const Hit beside = castRay(grid, eye, ecefFromPlace({49.6, 20.502, 900}) - eye);
  CHECK(beside.kind == HitKind::sky);
}

TEST_CASE("a void in the source makes the truth unknown there and nowhere else") {
  const HeightGrid grid(kOneDegree, [](double lat, double lon) {
    return std::abs(lat - 49.5) < 1e-6 && std::abs(lon - 20.5) < 1e-6 ? std::nan("") : 100.0;
  });
  CHECK(grid.voids() == 1);
  const Vec eye = ecefFromPlace({49.5003, 20.5003, 3000});
  CHECK(castRay(grid, eye, directionFrom({{49.5003, 20.5003, 3000}, 0, -90, 0})).kind == HitKind::unknown);
  CHECK(castRay(grid, eye, directionFrom({{49.5003, 20.5003, 3000}, 0, -80, 0})).kind == HitKind::terrain);
}

}  // namespace eye::truth
