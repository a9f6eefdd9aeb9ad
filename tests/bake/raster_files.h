// Small rasters for the tests, in a folder that goes away with the test.
#pragma once

#include <unistd.h>

#include <atomic>
#include <cmath>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "raster/geo_writer.h"

namespace eye {

struct TestFolder {
  std::filesystem::path path;
  TestFolder() {
    static std::atomic<int> serial{0};
    path = std::filesystem::temp_directory_path() /
           ("eye_bake_" + std::to_string(::getpid()) + "_" + std::to_string(serial++));
    std::filesystem::create_directories(path);
  }
  ~TestFolder() { std::filesystem::remove_all(path); }
  std::string file(const std::string& name) const { return path / name; }
};

// Posts at whole multiples of the step from the south-west corner.
inline GeoGrid postGrid(double southDeg, double westDeg, double stepDeg, int rows, int columns) {
  GeoGrid grid;
  grid.southDeg = southDeg;
  grid.westDeg = westDeg;
  grid.latStepDeg = grid.lonStepDeg = stepDeg;
  grid.rows = rows;
  grid.columns = columns;
  return grid;
}

using HeightFunction = std::function<double(double latDeg, double lonDeg)>;

inline std::string writeHeights(const std::string& path, const GeoGrid& grid, const HeightFunction& heightM) {
  std::vector<float> heights;
  for (int row = grid.rows - 1; row >= 0; --row) {
    for (int column = 0; column < grid.columns; ++column) {
      heights.push_back(
          static_cast<float>(heightM(grid.southDeg + row * grid.latStepDeg, grid.westDeg + column * grid.lonStepDeg)));
    }
  }
  if (!writeElevation(path, grid, heights)) std::abort();
  return path;
}

// Hills of some 100 m over tenths of a degree.
inline double hillsM(double latDeg, double lonDeg) {
  return 300 + 90 * std::sin(latDeg * 61) * std::cos(lonDeg * 47) + 40 * std::sin(latDeg * 190 + lonDeg * 130);
}

}  // namespace eye
