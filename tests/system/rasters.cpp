#include "system/rasters.h"

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <memory>

namespace eye::truth {
namespace {

struct Close {
  void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using Handle = std::unique_ptr<GDALDataset, Close>;

}  // namespace

void writeElevation(const std::string& path, const HeightGrid& grid, bool georeferenced) {
  GDALAllRegister();
  const GridShape& shape = grid.shape();
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  const Handle file(driver->Create(path.c_str(), shape.columns, shape.rows, 1, GDT_Float32, nullptr));
  REQUIRE(file != nullptr);
  if (georeferenced) {
    const double northDeg = shape.southDeg + (shape.rows - 0.5) * shape.stepDeg;
    double transform[6]{shape.westDeg - shape.stepDeg / 2, shape.stepDeg, 0, northDeg, 0, -shape.stepDeg};
    file->SetGeoTransform(transform);
    OGRSpatialReference wgs84;
    wgs84.SetWellKnownGeogCS("WGS84");
    file->SetSpatialRef(&wgs84);
  }
  GDALRasterBand* band = file->GetRasterBand(1);
  band->SetNoDataValue(-32768);
  std::vector<float> row(static_cast<size_t>(shape.columns));
  for (int r = 0; r < shape.rows; ++r) {
    for (int c = 0; c < shape.columns; ++c) {
      const float value = grid.postM(shape.rows - 1 - r, c);
      row[static_cast<size_t>(c)] = std::isnan(value) ? -32768 : value;
    }
    REQUIRE(band->RasterIO(GF_Write, 0, r, shape.columns, 1, row.data(), shape.columns, 1, GDT_Float32, 0, 0,
                           nullptr) == CE_None);
  }
}

RasterImage readRaster(const std::string& path) {
  GDALAllRegister();
  RasterImage image;
  const Handle file(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER));
  if (!file) return image;
  image.widthPx = file->GetRasterXSize();
  image.heightPx = file->GetRasterYSize();
  GDALRasterBand* first = file->GetRasterBand(1);
  int hasNoData = 0;
  image.noDataIsNan = std::isnan(first->GetNoDataValue(&hasNoData)) && hasNoData != 0;
  image.isFloat = first->GetRasterDataType() == GDT_Float32;
  const int bands = file->GetRasterCount();
  image.values.resize(static_cast<size_t>(image.widthPx) * static_cast<size_t>(image.heightPx) *
                      static_cast<size_t>(bands));
  if (file->RasterIO(GF_Read, 0, 0, image.widthPx, image.heightPx, image.values.data(), image.widthPx, image.heightPx,
                     GDT_Float32, bands, nullptr, 0, 0, 0, nullptr) == CE_None) {
    image.bands = bands;
  }
  return image;
}

}  // namespace eye::truth
