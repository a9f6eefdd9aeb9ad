// One elevation raster: what a first complete reading found, and its posts in metres.
#pragma once

#include <string>
#include <vector>

#include "base/error.h"
#include "raster/geo_raster.h"

namespace eye {

struct ElevationFile {
  std::string path;
  GeoGrid grid;
  bool warped = false;  // from a projected or otherwise turned system
  uint64_t posts = 0;
  uint64_t voids = 0;   // inside the data: to be filled
  uint64_t collar = 0;  // missing posts connected to a corner: the raster does not reach there
  double minM = 0, maxM = 0;
  // One flag a post, row 0 the northernmost; empty where there is no collar.
  std::vector<bool> collarMask;
  bool isCollar(int64_t row, int64_t column) const {
    return !collarMask.empty() && collarMask[static_cast<size_t>(row * grid.columns + column)];
  }
};

// Reads all of it once. A raster without georeference, without a valid post or with unreadable parts is an error.
Result<ElevationFile> scanElevation(const std::string& path);

// Rows from the northernmost, metres; NaN for missing posts. Opens the file anew, so any thread may call.
Result<void> readPosts(const ElevationFile& file, int firstRow, int firstColumn, int rows, int columns, float* heightM);

}  // namespace eye
