// Heights against the elevation that was baked, and lines of sight against heights along them.
#include "paging/ground_query.h"

#include <spdlog/spdlog.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "bake/bake_job.h"
#include "bake/raster_files.h"

namespace eye {
namespace {

constexpr double kErrorM = 2;
constexpr int kPostsPerDeg = 200;

double hillsM(double latDeg, double lonDeg) {
  return 600 + 300 * std::sin(latDeg * 90) * std::cos(lonDeg * 70) + 40 * std::sin(latDeg * 500 + lonDeg * 300);
}

// Bilinear between the posts, as the bake takes its source.
double bilinearM(double latDeg, double lonDeg) {
  const double row = std::floor(latDeg * kPostsPerDeg), column = std::floor(lonDeg * kPostsPerDeg);
  const double t = latDeg * kPostsPerDeg - row, s = lonDeg * kPostsPerDeg - column;
  const auto post = [](double r, double c) { return hillsM(r / kPostsPerDeg, c / kPostsPerDeg); };
  return (1 - t) * ((1 - s) * post(row, column) + s * post(row, column + 1)) +
         t * ((1 - s) * post(row + 1, column) + s * post(row + 1, column + 1));
}

const std::string& hills() {
  static const TestFolder folder;
  static const std::string path = [] {
    spdlog::set_level(spdlog::level::warn);
    BakeJob job;
    job.elevation = {writeHeights(folder.file("hills.tif"), postGrid(49, 20, 1.0 / kPostsPerDeg, 101, 101), hillsM)};
    job.out = folder.file("hills.eyt");
    job.plan.errorM = kErrorM;
    job.plan.textureSize = 16;
    BakeControl control;
    control.jobs = 2;
    const auto outcome = runBake(job, control);
    INFO((outcome ? std::string() : outcome.error().message));
    REQUIRE(outcome);
    return job.out;
  }();
  return path;
}

TEST_CASE("ground query: heights are the source's within the bake's error, at every point") {
  auto query = GroundQuery::open(hills());
  REQUIRE(query);
  std::mt19937_64 random(1);
  const auto within = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  double worstM = 0;
  for (int i = 0; i < 3000; ++i) {
    const double lat = within(49.05, 49.45), lon = within(20.05, 20.45);
    const auto hit = query->under(lat, lon);
    REQUIRE(hit);
    CHECK((hit->position.latDeg == lat && hit->position.lonDeg == lon));
    CHECK(glm::dot(hit->normalEcef, upAt(lat, lon)) > 0.3);
    worstM = std::max(worstM, std::abs(hit->position.altM - bilinearM(lat, lon)));
  }
  CHECK(worstM < kErrorM + 0.2);  // and the rounding of float posts and of the lattice
  CHECK(worstM > 0.1);
  const auto reader = DatabaseReader::open(hills());
  // Where there are no data: the sea; at the poles and the date line there is ground as well.
  for (const auto& [lat, lon] : {std::pair(-30.0, -120.0), {90.0, 0.0}, {-90.0, 77.0}, {0.0, 180.0}, {0.0, -180.0}}) {
    const auto hit = query->under(lat, lon);
    REQUIRE(hit);
    TileKey key = TileKey::containing(lat, lon, 0);
    while (reader->readMeta(key)->childCount > 0) key = TileKey::containing(lat, lon, key.level() + 1);
    CHECK(std::abs(hit->position.altM) <=
          reader->readMeta(key)->geometricErrorM + 0.1);  // coarse where there are no data
  }
}

TEST_CASE("ground query: a line of sight ends on the ground, and is above it before") {
  auto query = GroundQuery::open(hills());
  REQUIRE(query);
  std::mt19937_64 random(2);
  const auto within = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  const auto aboveM = [&](const Vec3d& ecefM) {
    const Geodetic at = geodeticFromEcef(ecefM);
    return at.altM - query->under(at.latDeg, at.lonDeg)->position.altM;
  };
  int hits = 0, misses = 0;
  for (int i = 0; i < 300; ++i) {
    const Geodetic a{within(49.1, 49.4), within(20.1, 20.4), within(900, 1500)};
    const Geodetic b{within(49.1, 49.4), within(20.1, 20.4), within(200, 1500)};
    const Vec3d from = ecefFromGeodetic(a), to = ecefFromGeodetic(b);
    if (aboveM(from) < 1) continue;
    const auto hit = query->between(from, to);
    REQUIRE(hit);
    const Vec3d end = *hit ? ecefFromGeodetic((*hit)->position) : to;
    ++(*hit ? hits : misses);
    if (*hit) {
      CHECK(std::abs(aboveM(end)) < 0.02);
      CHECK(glm::length(glm::cross(end - from, to - from)) < 0.01 * glm::length(to - from));  // on the line
    }
    double lowestM = 1e9;
    for (int k = 1; k < 100; ++k) lowestM = std::min(lowestM, aboveM(from + (end - from) * (k / 100.0)));
    CHECK(lowestM > -0.02);
    // The other way round it is seen as well or hidden as well.
    const auto back = query->between(to, from);
    REQUIRE(back);
    if (aboveM(to) > 1) CHECK(back->has_value() == hit->has_value());
  }
  CHECK(hits > 50);
  CHECK(misses > 20);
  // Straight through the Earth.
  const auto through = query->between(ecefFromGeodetic({49.2, 20.2, 5000}), ecefFromGeodetic({-49.2, -159.8, 5000}));
  REQUIRE((through && *through));
  CHECK((*through)->position.altM == Approx(bilinearM(49.2, 20.2)).margin(kErrorM + 0.2));
}

}  // namespace
}  // namespace eye
