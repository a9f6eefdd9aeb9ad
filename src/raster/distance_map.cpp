#include "raster/distance_map.h"

#include <gdal_priv.h>

#include <limits>

#include "raster/encode.h"

namespace eye {

Result<void> writeDistanceMap(const std::string& path, std::span<const float> rangeM, int widthPx, int heightPx) {
  EYE_CHECK(widthPx > 0 && heightPx > 0 && rangeM.size() == size_t(widthPx) * size_t(heightPx));
  const Dataset source = wrapPixels(rangeM.data(), widthPx, heightPx, 1, GDT_Float32, 4, 4);
  if (!source) return fail(ErrorKind::io, path + ": out of memory while encoding the distance map");
  GDALRasterBand* band = source->GetRasterBand(1);
  band->SetNoDataValue(std::numeric_limits<double>::quiet_NaN());
  band->SetUnitType("m");
  band->SetDescription("slant range from the eye");
  // Uncompressed: what writes every frame of a flight must be fast, and every reader takes it.
  const char* const options[] = {"BIGTIFF=IF_SAFER", nullptr};
  return encodeToFile(*source, "GTiff", options, path);
}

}  // namespace eye
