// The demo's airfield from above: runway with markings, taxiway and apron on mown grass.
#pragma once

#include <string>

#include "base/error.h"

namespace eye {

// A GeoTIFF with alpha: opaque on the airfield, fading out around it.
Result<void> writeDemoAirfield(const std::string& path);

}  // namespace eye
