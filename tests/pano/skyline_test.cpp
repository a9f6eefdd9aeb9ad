// The skyline of an island that is known in closed form, against rays marched over it in double precision: azimuth by
// azimuth, over GeographicLib's ellipsoid, with refraction and without.
#include <array>
#include <cmath>
#include <numbers>
#include <thread>

#include <fmt/format.h>
#include <GeographicLib/LocalCartesian.hpp>
#include <catch2/catch.hpp>

#include "pano/bake_ground.h"
#include "pano/render_panorama.h"
#include "render/renderer.h"

namespace eye {
namespace {

constexpr double kSouthDeg = 44, kWestDeg = 10, kHighDeg = 0.6, kWideDeg = 0.8, kStepDeg = 1.0 / 600;
constexpr double kFarthestM = 90000;
constexpr std::array kRefractions{0.0, 0.13, 0.25};
constexpr int kWidthPx = 4096;

// Hills and ridges of up to 1,500 m that end in the sea before the data do.
double islandM(double latDeg, double lonDeg) {
  const double s = (latDeg - kSouthDeg) / kHighDeg, t = (lonDeg - kWestDeg) / kWideDeg;
  if (s <= 0 || s >= 1 || t <= 0 || t >= 1) return 0;
  const double n = s * 66700, e = t * 63700;
  const double hills = 250 + 220 * std::sin(n / 2300) * std::cos(e / 2900) + 45 * std::sin(n / 640) * std::sin(e / 560);
  const double ridges = 900 * std::pow(0.5 + 0.5 * std::sin(n / 5200 + e / 8100), 2.0);
  const double fromShore = std::sin(s * std::numbers::pi) * std::sin(t * std::numbers::pi);
  return std::max(0.0, (hills + ridges) * std::min(1.0, 2.2 * (fromShore - 0.03)));
}

struct Standpoint {
  const char* name;
  double latDeg, lonDeg, overGroundM;
};
constexpr std::array<Standpoint, 3> kStandpoints{
    {{"ridge", 44.31, 10.42, 40}, {"valley", 44.22, 10.55, 15}, {"sea", 43.93, 10.45, 60}}};

const std::string& database() {
  static const TestFolder folder;
  const auto posts = [](double sizeDeg) { return static_cast<int>(std::lround(sizeDeg / kStepDeg)) + 1; };
  static const std::string path =
      bakeGround(folder, postGrid(kSouthDeg, kWestDeg, kStepDeg, posts(kHighDeg), posts(kWideDeg)), islandM, 0.5);
  return path;
}

// The highest elevation angle along an azimuth, for each refraction; degrees.
std::array<double, kRefractions.size()> marched(const Geodetic& eye, double azimuthDeg) {
  const GeographicLib::LocalCartesian local(eye.latDeg, eye.lonDeg, eye.altM);
  const double east = std::sin(radFromDeg(azimuthDeg)), north = std::cos(radFromDeg(azimuthDeg));
  std::array<double, kRefractions.size()> highest;
  highest.fill(-90);
  double upM = -eye.altM;
  for (double levelM = 5; levelM < kFarthestM; levelM += std::max(8.0, levelM / 800)) {
    // The ground over or under a level distance: the plumb line there leans, so it takes a second look.
    for (int look = 0; look < 2; ++look) {
      double latDeg = 0, lonDeg = 0, altM = 0;
      local.Reverse(east * levelM, north * levelM, upM, latDeg, lonDeg, altM);
      upM += islandM(latDeg, lonDeg) - altM;
    }
    for (size_t i = 0; i < kRefractions.size(); ++i) {
      const double liftM = kRefractions[i] * levelM * levelM / (2 * 6371000.0);
      highest[i] = std::max(highest[i], degFromRad(std::atan2(upM + liftM, levelM)));
    }
  }
  return highest;
}

std::vector<std::array<double, kRefractions.size()>> marchedAllRound(const Geodetic& eye) {
  std::vector<std::array<double, kRefractions.size()>> round(kWidthPx);
  const auto march = [&](int begin, int step) {
    for (int column = begin; column < kWidthPx; column += step)
      round[static_cast<size_t>(column)] = marched(eye, (column + 0.5) * 360 / kWidthPx);
  };
  std::jthread other(march, 1, 2);
  march(0, 2);
  return round;
}

}  // namespace

TEST_CASE("Skyline: within a pixel of marched rays from a ridge, a valley and the sea, for three refractions") {
  const auto devices = Renderer::listDevices();
  if (!devices || devices->empty()) {
    WARN("no Vulkan device: not tested");
    return;
  }
  for (const Standpoint& at : kStandpoints) {
    CAPTURE(at.name);
    PanoramaOptions options;
    options.terrain = database();
    options.eye = {at.latDeg, at.lonDeg, islandM(at.latDeg, at.lonDeg) + at.overGroundM};
    options.frame = panoramaFrame(kWidthPx, 50);
    options.cacheGpuMiB = 256;
    const auto truth = marchedAllRound(options.eye);
    for (size_t i = 0; i < kRefractions.size(); ++i) {
      options.refraction = kRefractions[i];
      const auto rendered = renderPanorama(options);
      INFO((rendered ? std::string() : rendered.error().message));
      REQUIRE(rendered);
      const std::vector<int> rows = skylineRows(rendered->panorama);
      int within = 0;
      double worst = 0;
      for (size_t column = 0; column < rows.size(); ++column) {
        const double off = std::abs(rows[column] - options.frame.yOf(truth[column][i]));
        within += off <= 1 ? 1 : 0;
        worst = std::max(worst, off);
      }
      fmt::print("skyline from the {}, k = {}: {} of {} columns within a pixel, the worst {:.2f} off\n", at.name,
                 options.refraction, within, kWidthPx, worst);
      CHECK(within * 1000 >= kWidthPx * 999);
    }
  }
}

}  // namespace eye
