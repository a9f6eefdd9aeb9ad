// What encloses a chunk: a sphere, an oriented box, and the point that tells when all of it is below the horizon.
#pragma once

#include <span>

#include "terrain/chunk.h"

namespace eye {

// Sets sphere, box and horizon point of `meta`; all are conservative for the triangles between the vertices.
// `place` is about the middle of the tile: the box' axes are east, north, up there.
void setBounds(std::span<const Vec3d> verticesEcefM, LatLon place, ChunkMeta& meta);

}  // namespace eye
