#include <catch2/catch.hpp>

#include "geo/scene_bend.h"

namespace eye {
namespace {

const Geodetic kEye{46.5, 8.1, 3000};

}  // namespace

TEST_CASE("Bend: nothing without refraction on the ellipsoid") {
  CHECK(sceneBend(46.5, 0, EarthShape::ellipsoid) == SceneBend{});
}

TEST_CASE("Bend: an arc of light is drawn as a straight line and measured straight") {
  constexpr double kRefraction = 0.13;
  const SceneBend bend = sceneBend(46.5, kRefraction, EarthShape::ellipsoid);
  // A ray that leaves level, eastwards and northwards at once: an arc of the radius R / k, exactly.
  const double radiusM = kMeanEarthRadiusM / kRefraction;
  for (const double angle : {0.0005, 0.001, 0.002}) {  // 25 to 98 km
    const double alongM = radiusM * std::sin(angle), upM = radiusM * (std::cos(angle) - 1);
    const Vec3d onArc(alongM * 0.6, alongM * 0.8, upM), drawn = bentEnu(bend, onArc);
    CHECK(drawn.z == Approx(0).margin(1e-3));
    CHECK(glm::distance(unrefractedEnu(bend, drawn), onArc) < 1e-9);
  }
}

TEST_CASE("Bend: the sphere's stretch and lift come within 8 m of the sphere at 100 km") {
  for (const double latDeg : {0.0, 46.5, -70.0}) {
    const Geodetic eye{latDeg, 8.1, 3000};
    const SceneBend bend = sceneBend(latDeg, 0, EarthShape::sphere);
    for (const double azimuth : {0.0, 0.8, 1.6, 2.4, 3.9}) {
      const double lonScale = std::cos(radFromDeg(latDeg));
      const Geodetic point{latDeg + 0.9 * std::cos(azimuth), 8.1 + 0.9 * std::sin(azimuth) / lonScale, 2000};
      const Vec3d drawn = bentEnu(bend, offsetEnu(eye, point, EarthShape::ellipsoid));
      const Vec3d truth = offsetEnu(eye, point, EarthShape::sphere);
      CHECK(glm::distance(drawn, truth) < 8);
      CHECK(glm::distance(offsetEnu(eye, point, EarthShape::ellipsoid), truth) > 20);  // it does something
      CHECK(unrefractedEnu(bend, drawn) == drawn);
    }
  }
}

TEST_CASE("Bend: refraction over a sphere leaves the sphere when it is taken out again") {
  const SceneBend bent = sceneBend(kEye.latDeg, 0.2, EarthShape::sphere);
  const SceneBend straight = sceneBend(kEye.latDeg, 0, EarthShape::sphere);
  const Vec3d offset = offsetEnu(kEye, {47.1, 8.9, 1200}, EarthShape::ellipsoid);
  CHECK(glm::distance(unrefractedEnu(bent, bentEnu(bent, offset)), bentEnu(straight, offset)) < 1e-8);
}

}  // namespace eye
