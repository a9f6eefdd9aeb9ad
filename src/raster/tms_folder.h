// A folder of map tiles (OSGeo's Tile Map Service): tilemapresource.xml beside LEVEL/COLUMN/ROW.jpg or .png.
#pragma once

#include <string>

#include "base/error.h"

namespace eye {

bool isTmsFolder(const std::string& folder);

// A path in GDAL's memory: one raster of the finest level's tiles, transparent where one is missing. Each folder is
// read once a process. GDAL's own driver would fetch the tiles from where the file says that they are served.
Result<std::string> rasterOfTmsFolder(const std::string& folder);

}  // namespace eye
