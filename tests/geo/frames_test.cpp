#include "geo/frames.h"

#include <cmath>
#include <random>

#include <catch2/catch.hpp>

namespace eye {
namespace {

constexpr double kLats[] = {-90, -89.999999, -67.5, -45, -1e-9, 0, 12.3, 45, 49.1793, 78.75, 89.999999, 90};
constexpr double kLons[] = {-180, -179.999999, -90, -45, 0, 1e-9, 20.0881, 90, 135, 179.999999, 180};

double lonDifference(double a, double b) {
  return std::abs(std::remainder(a - b, 360.0));
}

bool isNear(const Vec3d& a, const Vec3d& b, double tolerance = 1e-14) {
  return glm::length(a - b) <= tolerance;
}

TEST_CASE("points on the axes are where WGS84 puts them") {
  CHECK(ecefFromGeodetic({0, 0, 0}) == Vec3d(kSemiMajorM, 0, 0));
  CHECK(ecefFromGeodetic({0, 90, 100}) == Vec3d(0, kSemiMajorM + 100, 0));
  CHECK(isNear(ecefFromGeodetic({90, 0, 0}), Vec3d(0, 0, kSemiMinorM), 2e-9));
  CHECK(isNear(ecefFromGeodetic({-90, 77, 1000}), Vec3d(0, 0, -kSemiMinorM - 1000), 2e-9));
}

TEST_CASE("a known point agrees with published coordinates") {
  // EPSG Guidance Note 7-2, geographic/geocentric conversions: 53 48 33.820 N, 2 07 46.380 E, 73.0 m.
  const Geodetic g{53.0 + 48.0 / 60 + 33.820 / 3600, 2.0 + 7.0 / 60 + 46.380 / 3600, 73.0};
  CHECK(isNear(ecefFromGeodetic(g), Vec3d(3771793.968, 140253.342, 5124304.349), 2e-3));
}

TEST_CASE("the date line and the poles are exact") {
  for (const double lat : kLats) {
    const Vec3d west = ecefFromGeodetic({lat, -180, 123}), east = ecefFromGeodetic({lat, 180, 123});
    for (int i = 0; i < 3; ++i) {
      CHECK(west[i] == east[i]);
      CHECK(std::signbit(west[i]) == std::signbit(east[i]));
    }
    CHECK(ecefFromGeodetic({lat, 180, 0}).y == 0.0);
  }
  for (const double lon : kLons) {
    CHECK(ecefFromGeodetic({90, lon, 8}) == ecefFromGeodetic({90, 0, 8}));
    CHECK(ecefFromGeodetic({-90, lon, 8}) == ecefFromGeodetic({-90, 0, 8}));
    CHECK(ecefFromGeodetic({90, lon, 8}).x == 0.0);
  }
}

TEST_CASE("geodetic coordinates come back") {
  std::vector<Geodetic> points;
  for (const double lat : kLats)
    for (const double lon : kLons)
      for (const double alt : {-430.0, 0.0, 8848.0, 400e3}) points.push_back({lat, lon, alt});
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 20'000; ++i)
    points.push_back({90 * unit(random), 180 * unit(random), 20'000 * (unit(random) + 0.9)});

  for (const Geodetic& g : points) {
    const Vec3d ecefM = ecefFromGeodetic(g);
    const Geodetic back = geodeticFromEcef(ecefM);
    CAPTURE(g.latDeg, g.lonDeg, g.altM);
    REQUIRE(std::abs(back.latDeg - g.latDeg) <= 1e-9);
    REQUIRE(std::abs(back.altM - g.altM) <= 1e-6);
    REQUIRE((back.latDeg >= -90 && back.latDeg <= 90 && back.lonDeg >= -180 && back.lonDeg <= 180));
    // A longitude at a pole is no place; near one it is as good as the metres it means.
    REQUIRE(lonDifference(back.lonDeg, g.lonDeg) * std::cos(radFromDeg(g.latDeg)) <= 1e-9);
    REQUIRE(isNear(ecefFromGeodetic(back), ecefM, 1e-6));
  }
}

TEST_CASE("frames are right-handed and orthonormal everywhere") {
  for (const double lat : kLats)
    for (const double lon : kLons) {
      const Mat3d m = ecefFromEnu(lat, lon);
      const Mat3d product = glm::transpose(m) * m;
      for (int i = 0; i < 3; ++i) CHECK(isNear(product[i], Mat3d(1.0)[i]));
      CHECK(glm::determinant(m) == Approx(1.0).epsilon(1e-14));
      CHECK(m[2] == upAt(lat, lon));
      CHECK(glm::determinant(ecefFromEye(Pose{{lat, lon, 0}, 123, -45, 67})) == Approx(1.0).epsilon(1e-13));
    }
  CHECK(glm::determinant(bodyFromEye()) == 1.0);
}

TEST_CASE("up is away from the ellipsoid; east and north are where latitude and longitude grow") {
  for (const double lat : {-80.0, -30.0, 0.0, 49.0, 85.0})
    for (const double lon : {-170.0, -10.0, 20.0, 100.0}) {
      const Mat3d enu = ecefFromEnu(lat, lon);
      const Vec3d here = ecefFromGeodetic({lat, lon, 0});
      const double d = 1e-5;
      CHECK(isNear(glm::normalize(ecefFromGeodetic({lat, lon + d, 0}) - here), enu[0], 1e-6));
      CHECK(isNear(glm::normalize(ecefFromGeodetic({lat + d, lon, 0}) - here), enu[1], 1e-6));
      CHECK(isNear((ecefFromGeodetic({lat, lon, 1000}) - here) / 1000.0, enu[2], 1e-9));
    }
}

TEST_CASE("heading turns clockwise from north, pitch raises the nose, roll lowers the right wing") {
  const Vec3d east(1, 0, 0), north(0, 1, 0), up(0, 0, 1);
  const auto axes = [](double heading, double pitch, double roll) { return enuFromBody(heading, pitch, roll); };
  const Mat3d level = axes(0, 0, 0);
  CHECK(isNear(level[0], north));
  CHECK(isNear(level[1], east));
  CHECK(isNear(level[2], -up));

  CHECK(isNear(axes(90, 0, 0)[0], east));
  CHECK(isNear(axes(90, 0, 0)[1], -north));  // looking east, south is at the right
  CHECK(isNear(axes(270, 0, 0)[0], -east));

  CHECK(isNear(axes(0, 90, 0)[0], up));
  CHECK(isNear(axes(0, 30, 0)[0], north * std::sqrt(0.75) + up * 0.5, 1e-15));
  CHECK(isNear(axes(90, 30, 0)[0], east * std::sqrt(0.75) + up * 0.5, 1e-15));
  CHECK(isNear(axes(90, 30, 0)[1], -north));  // pitch leaves the wings level

  CHECK(isNear(axes(0, 0, 90)[1], -up));    // the right wing points down
  CHECK(isNear(axes(0, 0, 90)[0], north));  // roll leaves the nose where it is
  CHECK(axes(0, 0, 10)[1].z < 0);
  CHECK(isNear(axes(37, 21, 50)[0], axes(37, 21, 0)[0], 1e-15));
}

TEST_CASE("the eye looks along the body's nose, its right is the right wing's") {
  const Mat3d m = bodyFromEye();
  CHECK(m * Vec3d(0, 0, 1) == Vec3d(1, 0, 0));
  CHECK(m * Vec3d(1, 0, 0) == Vec3d(0, 1, 0));
  CHECK(m * Vec3d(0, 1, 0) == Vec3d(0, 0, 1));
  // At 0 N, 0 E looking east: forward is ecef y, the eye's down is towards the Earth's centre.
  const Mat3d eye = ecefFromEye(Pose{{0, 0, 1000}, 90, 0, 0});
  CHECK(isNear(eye[2], Vec3d(0, 1, 0)));
  CHECK(isNear(eye[1], Vec3d(-1, 0, 0)));
  CHECK(isNear(eye[0], Vec3d(0, 0, -1)));
}

}  // namespace
}  // namespace eye
