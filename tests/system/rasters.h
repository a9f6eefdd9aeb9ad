// Rasters in and out of the tests, through GDAL itself.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "truth/height_grid.h"

namespace eye::truth {

// A GeoTIFF of Float32 posts at pixel centres in WGS84. `georeferenced` false leaves the place out.
void writeElevation(const std::string& path, const HeightGrid& grid, bool georeferenced = true);

struct RasterImage {
  int widthPx = 0, heightPx = 0, bands = 0;
  bool isFloat = false, noDataIsNan = false;
  std::vector<float> values;  // band by band, row 0 on top
  float at(int band, int row, int column) const {
    return values[(static_cast<size_t>(band) * static_cast<size_t>(heightPx) + static_cast<size_t>(row)) *
                      static_cast<size_t>(widthPx) +
                  static_cast<size_t>(column)];
  }
};
// Zero bands where it cannot be read.
RasterImage readRaster(const std::string& path);

}  // namespace eye::truth
