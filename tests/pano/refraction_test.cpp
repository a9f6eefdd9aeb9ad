// Refraction and the Earth's curvature where both are known in closed form: two peaks that stand in the sea.
#include <cmath>

#include <catch2/catch.hpp>

#include "pano/bake_ground.h"
#include "pano/peaks.h"
#include "pano/render_panorama.h"
#include "render/renderer.h"

namespace eye {
namespace {

// Both on the meridian of 10 E, seen from 45 N 10 E: at 67 and 167 km. The far one's foot is behind the horizon.
const Geodetic kEye{45, 10, 60};
const Geodetic kNear{45.6, 10, 340}, kFar{46.5, 10, 2000};
constexpr double kStepDeg = 1.0 / 200;

double peaksM(double latDeg, double lonDeg) {
  const auto cone = [&](const Geodetic& peak) {
    return peak.altM - 0.15 * 111200 * std::hypot(latDeg - peak.latDeg, (lonDeg - peak.lonDeg) * 0.7);
  };
  return std::max({0.0, cone(kNear), cone(kFar)});
}

const std::string& database() {
  static const TestFolder folder;
  static const std::string path = bakeGround(folder, postGrid(44.8, 9.7, kStepDeg, 401, 121), peaksM, 1);
  return path;
}

std::optional<Panorama> seen(double refraction, EarthShape earth) {
  const auto devices = Renderer::listDevices();
  if (!devices || devices->empty()) {
    WARN("no Vulkan device: not tested");
    return std::nullopt;
  }
  PanoramaOptions options;
  options.terrain = database();
  options.eye = kEye;
  options.frame = panoramaFrame(16384, 3);
  options.refraction = refraction;
  options.earth = earth;
  options.cacheGpuMiB = 128;
  auto rendered = renderPanorama(options);
  INFO((rendered ? std::string() : rendered.error().message));
  REQUIRE(rendered);
  return std::move(rendered->panorama);
}

// The surveyors' formula over a sphere, with the arc of light in closed form; degrees.
double elevationDeg(const Geodetic& peak, double refraction) {
  const double angle = radFromDeg(peak.latDeg - kEye.latDeg);
  const double eyeR = kMeanEarthRadiusM + kEye.altM, peakR = kMeanEarthRadiusM + peak.altM;
  const double up = peakR * std::cos(angle) - eyeR, level = peakR * std::sin(angle);
  return degFromRad(std::atan2(up, level) + std::asin(refraction * std::hypot(up, level) / (2 * kMeanEarthRadiusM)));
}

}  // namespace

TEST_CASE("Refraction: two peaks over a sphere stand where the closed form has them, within a pixel") {
  for (const double refraction : {0.0, 0.13, 0.3}) {
    CAPTURE(refraction);
    const auto panorama = seen(refraction, EarthShape::sphere);
    if (!panorama) return;
    const PanoramaFrame& frame = panorama->frame;
    const std::vector<int> skyline = skylineRows(*panorama);
    // Of the two in one direction the higher is the skyline. The near one is it without refraction; with enough of it,
    // the far one.
    const double nearDeg = elevationDeg(kNear, refraction), farDeg = elevationDeg(kFar, refraction);
    const double highest = std::max(nearDeg, farDeg);
    CHECK((farDeg > nearDeg) == (refraction > 0.05));
    CHECK(skyline[0] == Approx(frame.yOf(highest)).margin(1.0));
    const double distanceM = panorama->distanceM[frame.at(0, skyline[0])];
    CHECK(distanceM ==
          Approx(glm::length(offsetEnu(kEye, farDeg > nearDeg ? kFar : kNear, EarthShape::sphere))).epsilon(2e-3));
  }
}

TEST_CASE("Refraction: on the ellipsoid the skyline rises by k d / 2R") {
  const auto straight = seen(0, EarthShape::ellipsoid), bent = seen(0.3, EarthShape::ellipsoid);
  if (!straight || !bent) return;
  const SceneBend none, bend = sceneBend(kEye.latDeg, 0.3, EarthShape::ellipsoid);
  const PanoramaFrame& frame = straight->frame;
  const auto rowOf = [&](const SceneBend& b) {
    return frame.yOf(std::max(sightingOf(kEye, kNear, b, EarthShape::ellipsoid).elevationDeg,
                              sightingOf(kEye, kFar, b, EarthShape::ellipsoid).elevationDeg));
  };
  CHECK(skylineRows(*straight)[0] == Approx(rowOf(none)).margin(1));
  CHECK(skylineRows(*bent)[0] == Approx(rowOf(bend)).margin(1));
  CHECK(skylineRows(*bent)[0] < skylineRows(*straight)[0] - 5);
}

}  // namespace eye
