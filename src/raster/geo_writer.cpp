#include "raster/geo_writer.h"

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <array>
#include <limits>

#include <fmt/format.h>

#include "raster/encode.h"

namespace eye {

namespace {

Result<void> write(const std::string& path, const GeoGrid& grid, Dataset source) {
  if (!source) return fail(ErrorKind::io, path + ": out of memory while encoding");
  OGRSpatialReference wgs84;
  wgs84.importFromEPSG(4326);
  wgs84.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  std::array<double, 6> transform{grid.westDeg - grid.lonStepDeg / 2,
                                  grid.lonStepDeg,
                                  0,
                                  grid.northDeg() + grid.latStepDeg / 2,
                                  0,
                                  -grid.latStepDeg};
  source->SetSpatialRef(&wgs84);
  source->SetGeoTransform(transform.data());
  GdalMessages messages;
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  const char* const options[] = {"TILED=YES", "COMPRESS=DEFLATE", "ZLEVEL=1", "BIGTIFF=IF_SAFER", nullptr};
  Dataset copy(driver->CreateCopy(path.c_str(), source.get(), FALSE, const_cast<char**>(options), nullptr, nullptr));
  if (copy) copy->FlushCache();
  if (copy && messages.failure().empty()) return {};
  return fail(ErrorKind::io, fmt::format("{}: cannot write: {}", path, messages.failure()));
}

}  // namespace

Result<void> writeElevation(const std::string& path, const GeoGrid& grid, std::span<const float> heightM) {
  EYE_CHECK(heightM.size() == size_t(grid.rows) * size_t(grid.columns));
  Dataset source = wrapPixels(heightM.data(), grid.columns, grid.rows, 1, GDT_Float32, 4, 4);
  if (source) source->GetRasterBand(1)->SetNoDataValue(std::numeric_limits<double>::quiet_NaN());
  return write(path, grid, std::move(source));
}

Result<void> writeImagery(const std::string& path, const GeoGrid& grid, std::span<const uint8_t> rgba) {
  EYE_CHECK(rgba.size() == size_t(grid.rows) * size_t(grid.columns) * 4);
  Dataset source = wrapPixels(rgba.data(), grid.columns, grid.rows, 4, GDT_Byte, 1, 4);
  if (source) source->GetRasterBand(4)->SetColorInterpretation(GCI_AlphaBand);
  return write(path, grid, std::move(source));
}

}  // namespace eye
