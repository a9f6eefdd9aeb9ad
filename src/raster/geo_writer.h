// Georeferenced rasters out, in WGS84 latitude and longitude: GeoTIFF.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "base/error.h"
#include "raster/geo_raster.h"

namespace eye {

// `path` may lie in GDAL's memory (/vsimem/...). Row 0 is the northernmost; NaN is NoData.
Result<void> writeElevation(const std::string& path, const GeoGrid& grid, std::span<const float> heightM);
// 4 bytes a pixel, alpha last.
Result<void> writeImagery(const std::string& path, const GeoGrid& grid, std::span<const uint8_t> rgba);

}  // namespace eye
