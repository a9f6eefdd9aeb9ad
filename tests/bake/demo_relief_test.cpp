#include "bake/demo_relief.h"

#include <catch2/catch.hpp>

#include <filesystem>

#include <unistd.h>

#include "raster/geo_writer.h"

using namespace eye;

namespace {

// Half-degree posts from longitude 0: 1000 m where the longitude is in [90, 180], sea floor elsewhere.
std::string writeRelief() {
  const std::string path =
      (std::filesystem::temp_directory_path() / ("eyepoint_relief_" + std::to_string(getpid()) + ".tif")).string();
  GeoGrid grid;
  grid.southDeg = -90;
  grid.westDeg = 0;
  grid.latStepDeg = grid.lonStepDeg = 0.5;
  grid.rows = 361;
  grid.columns = 720;
  std::vector<float> heights;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column)
      heights.push_back(column >= 180 && column <= 360 ? 1000.0f : -4000.0f);
  REQUIRE(writeElevation(path, grid, heights));
  return path;
}

}  // namespace

TEST_CASE("an installed relief becomes the demo's globe: cell means, longitudes from -180, sea at 0") {
  const std::string path = writeRelief();
  GeoGrid world;
  world.southDeg = -87.5;
  world.westDeg = -177.5;
  world.latStepDeg = world.lonStepDeg = 5;
  world.rows = 36;
  world.columns = 72;
  const auto heights = installedReliefM(path, world);
  std::filesystem::remove(path);
  REQUIRE(heights);
  REQUIRE(heights->size() == 36 * 72);
  for (int row = 0; row < world.rows; ++row) {
    const auto at = [&](int column) { return (*heights)[static_cast<size_t>(row * world.columns + column)]; };
    CHECK(at(60) == 1000.0f);                     // 122.5 east
    CHECK(at(20) == 0.0f);                        // 77.5 west
    CHECK(at(0) < 200.0f);                        // 177.5 west: its cell ends at the date line
    CHECK(at(54) == Approx(1000.0).margin(100));  // 92.5: its cell begins at 90
  }
}

TEST_CASE("no relief is no error") {
  CHECK_FALSE(installedReliefM("/nonexistent/etopo5.cdf", GeoGrid{}));
}
