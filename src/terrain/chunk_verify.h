// What must hold of a stored chunk beyond its checksum.
#pragma once

#include "base/error.h"
#include "terrain/database.h"

namespace eye {

// Both blobs decode, box, sphere and heights hold every vertex, clusters' boxes and cones their triangles. The error is
// without file and tile.
Result<void> checkContents(const StoredChunk& chunk, int textureSize);

}  // namespace eye
