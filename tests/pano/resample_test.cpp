// From a view's pixels to columns of one azimuth and rows of one elevation, without a renderer: the view's depth is
// computed from planes.
#include <cmath>

#include <catch2/catch.hpp>

#include "pano/planar_depth.h"
#include "pano/resample.h"
#include "pano/run.h"
#include "pano/views.h"

namespace eye {
namespace {

const Geodetic kEye{46.5, 8.1, 2000};

Panorama blank(const PanoramaFrame& frame) {
  Panorama panorama{frame, kEye, {}, {}};
  panorama.rgba.resize(frame.pixels() * 4);
  panorama.distanceM.resize(frame.pixels());
  return panorama;
}

// What a renderer would have read back of a plane: dot(normal, point) = 1 in the view's own frame.
std::vector<float> depthOfPlane(const View& view, Vec3d normal) {
  std::vector<float> depth;
  for (int row = 0; row < view.heightPx; ++row)
    for (int column = 0; column < view.widthPx; ++column) {
      const Vec3d ray = rayThroughPixel(view.frustum, view.widthPx, view.heightPx, column, row);
      depth.push_back(static_cast<float>(view.frustum.nearM * glm::dot(normal, ray)));
    }
  return depth;
}

}  // namespace

TEST_CASE("Resample: a plane's distance is exact in every pixel of all eight views") {
  const PanoramaFrame frame = panoramaFrame(1003, 40);  // not a multiple of eight
  const SceneBend bend;
  Panorama panorama = blank(frame);
  const Vec3d normal(0.0002, 0.0003, 0.001);  // of a leaning wall, 1 / metres
  for (int index = 0; index < kViews; ++index) {
    const View view = panoramaView(frame, kEye, bend, index);
    const std::vector<float> depth = depthOfPlane(view, normal);
    resample(view, index, std::vector<uint8_t>(depth.size() * 4, 90), depth, bend, panorama);
  }
  double worst = 0;
  for (int row = 0; row < frame.heightPx; ++row) {
    for (int column = 0; column < frame.widthPx; ++column) {
      const double azimuthDeg = frame.azimuthDeg(column + 0.5),
                   elevationRad = radFromDeg(frame.elevationDeg(row + 0.5));
      const double turn = radFromDeg(azimuthDeg - viewHeadingDeg(static_cast<int>(azimuthDeg / kViewDeg)));
      const Vec3d ray(std::sin(turn) * std::cos(elevationRad), -std::sin(elevationRad),
                      std::cos(turn) * std::cos(elevationRad));
      const double truthM = 1 / glm::dot(normal, ray);
      worst = std::max(worst, std::abs(panorama.distanceM[frame.at(column, row)] / truthM - 1));
    }
  }
  CHECK(worst < 2e-7);
  CHECK(std::ranges::all_of(panorama.rgba, [](uint8_t value) { return value == 90 || value == 255; }));
}

TEST_CASE("Resample: refraction is taken out of the distance") {
  const PanoramaFrame frame = panoramaFrame(720, 4);
  const SceneBend bend = sceneBend(kEye.latDeg, 0.3, EarthShape::ellipsoid);
  Panorama panorama = blank(frame);
  const View view = panoramaView(frame, kEye, bend, 0);
  const Vec3d normal(0, 0, 1 / 200e3);  // a wall at 200 km: light falls 942 m on its way
  resample(view, 0, std::vector<uint8_t>(static_cast<size_t>(view.widthPx * view.heightPx) * 4),
           depthOfPlane(view, normal), bend, panorama);
  const int column = 45, row = 1;  // on the view's axis; 1.0 degree up
  const double levelM = 200e3 / std::cos(radFromDeg(0.25));
  const double upM =
      levelM * std::tan(radFromDeg(frame.elevationDeg(row + 0.5))) - 0.3 * levelM * levelM / (2 * kMeanEarthRadiusM);
  CHECK(panorama.distanceM[frame.at(column, row)] == Approx(std::hypot(levelM, upM)).epsilon(1e-6));
}

TEST_CASE("Resample: at a silhouette one of the two distances, never one between") {
  const PanoramaFrame frame = panoramaFrame(720, 20);
  const SceneBend bend;
  Panorama panorama = blank(frame);
  const View view = panoramaView(frame, kEye, bend, 0);
  std::vector<float> depth = depthOfPlane(view, {0, 0, 1e-3});
  for (size_t i = 0; i < depth.size(); i += 3) depth[i] *= 0.1f;
  for (size_t i = 1; i < depth.size(); i += 5) depth[i] = 0;
  resample(view, 0, std::vector<uint8_t>(depth.size() * 4), depth, bend, panorama);
  for (int row = 0; row < frame.heightPx; ++row) {
    for (int column = 0; column < 90; ++column) {
      const double alongRay = std::cos(radFromDeg(frame.elevationDeg(row + 0.5))) *
                              std::cos(radFromDeg(frame.azimuthDeg(column + 0.5) - 22.5));
      const double depthM = panorama.distanceM[frame.at(column, row)] * alongRay;
      if (!std::isnan(depthM)) REQUIRE((std::abs(depthM - 1000) < 0.01 || std::abs(depthM - 10000) < 0.1));
    }
  }
}

TEST_CASE("Planar depth: the paper's equations are each other's inverse, up to the buffer's steps") {
  const PaperBuffer fine{1, 200000, 48};
  for (const double depthM : {2.0, 150.0, 9000.0, 120000.0})
    CHECK(paperDepthM(fine, paperBufferValue(fine, depthM)) == Approx(depthM).epsilon(1e-4));
  // A step of 24 bits is z^2 / (n 2^24): 149 m at 50 km with the near plane at 1 m, ten times that at 10 cm.
  const auto step = [](double nearM, double depthM) {
    const PaperBuffer buffer{nearM, 200000, 24};
    const double value = paperBufferValue(buffer, depthM);
    return paperDepthM(buffer, value + 1 / 16777215.0) - paperDepthM(buffer, value);
  };
  CHECK(step(1, 50000) == Approx(149).epsilon(0.02));
  CHECK(step(0.1, 50000) == Approx(1490).epsilon(0.06));
}

TEST_CASE("option --at: a position, an altitude, a height above the ground") {
  CHECK(parseEyeWish("49.2,20.1")->latDeg == 49.2);
  CHECK_FALSE(parseEyeWish("49.2,20.1")->altM);
  CHECK(parseEyeWish("49.2,20.1,2500")->altM == 2500.0);
  CHECK(parseEyeWish("-49.2,-20.1,+5")->aboveGroundM == 5.0);
  CHECK_FALSE(parseEyeWish("49.2,20.1,+5")->altM);
  CHECK(parseEyeWish("10,-30,-3")->altM == -3.0);
  for (const char* bad :
       {"", "49", "49,20,1,2", "49,20,", "49,x", "nan,20", "91,20", "49,500", "49,20,inf", "+,+", "49,20,2e6"}) {
    INFO(bad);
    const auto wish = parseEyeWish(bad);
    REQUIRE_FALSE(wish);
    CHECK(wish.error().kind == ErrorKind::usage);
    CHECK(wish.error().message.find('\n') == std::string::npos);
  }
}

}  // namespace eye
