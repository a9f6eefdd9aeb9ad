// Encoding of an in-memory raster by a GDAL driver into a file that appears whole.
#pragma once

#include <string>

#include "base/error.h"
#include "raster/gdal.h"

namespace eye {

// A GDAL dataset over `pixels`, which must outlive it: `bands` values of `bytesPerValue` side by side per pixel of
// `pixelBytes`. `gdalType` is a GDALDataType.
Dataset wrapPixels(const void* pixels, int widthPx, int heightPx, int bands, int gdalType, int bytesPerValue,
                   int pixelBytes);

// Encodes with the driver (e.g. "PNG") in memory, then writes.
Result<void> encodeToFile(GDALDataset& source, const char* driverName, const char* const* options,
                          const std::string& path);

}  // namespace eye
