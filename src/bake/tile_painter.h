// A tile's picture: from imagery, and from the palette where no imagery reaches.
#pragma once

#include <cstdint>
#include <vector>

#include "bake/elevation.h"
#include "bake/imagery_mosaic.h"

namespace eye {

// A texel's height in degrees of latitude, and in metres.
double texelDeg(int level, int textureSize);
double texelM(int level, int textureSize);

// size * size * 3 bytes as encodeImagery wants them. `imagery` may be null. Thread: any number at once.
Result<std::vector<uint8_t>> paintTile(const TileKey& key, int size, const ElevationSurface& surface,
                                       const ImageryMosaic* imagery);

}  // namespace eye
