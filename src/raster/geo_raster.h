// A raster as posts on a regular grid of WGS84 latitude and longitude, warped to that when it is in another system.
#pragma once

#include <string>

#include "base/error.h"
#include "raster/gdal.h"

namespace eye {

// Posts are pixel centres (GDAL's geotransform has dealt with PixelIsArea and PixelIsPoint).
struct GeoGrid {
  double southDeg = 0, westDeg = 0;  // of the south-westernmost post
  double latStepDeg = 0, lonStepDeg = 0;
  int rows = 0, columns = 0;
  double northDeg() const { return southDeg + latStepDeg * (rows - 1); }
  double eastDeg() const { return westDeg + lonStepDeg * (columns - 1); }
};

enum class RasterUse { elevation, imagery };

// Thread: one at a time.
struct GeoRaster {
  Dataset source;
  Dataset view;  // warped or palette-expanded view of `source`; none where that is used as it is
  GeoGrid grid;
  bool warped = false;
  bool takenForGlobe = false;  // has no georeference
  GDALDataset& dataset() const { return view ? *view : *source; }
};

// Row 0 of the dataset is the northernmost. For elevation the warped view is Float32 with NaN as NoData; for imagery it
// has an alpha band, and a palette is expanded to RGBA. A raster without georeference is an error that says how to give
// it one; but a picture exactly twice as wide as high is the whole globe in latitude and longitude, north up, from the
// date line to the date line, which is how pictures of the globe are passed around.
Result<GeoRaster> openGeoRaster(const std::string& path, RasterUse use);

}  // namespace eye
