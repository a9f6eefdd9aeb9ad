// Which rasters a source argument means.
#pragma once

#include <string>
#include <vector>

#include "base/error.h"

namespace eye {

// `source`: a file, an archive with rasters in it, a path into GDAL's file systems, or a folder, searched recursively
// for what GDAL opens. Sorted by path, never empty: a source without a single raster is an error.
Result<std::vector<std::string>> findRasters(const std::string& source);

}  // namespace eye
