// Orthometric heights to heights above the ellipsoid: the undulation of a geoid.
#pragma once

#include <string>

#include "bake/elevation_layer.h"
#include "base/error.h"

namespace eye {

// `datum`: egm84, egm96 or egm2008, looked for among PROJ's and GeographicLib's installed grids, or a file: any raster
// of undulations in metres that GDAL opens (.gtx, .tif, ...) or a GeographicLib .pgm. The result may be called by any
// thread.
Result<HeightCorrection> loadVerticalDatum(const std::string& datum);

}  // namespace eye
