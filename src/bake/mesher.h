// A tile's mesh: a triangulated irregular network with a guaranteed maximum error against the bilinear surface.
#pragma once

#include "bake/elevation.h"
#include "terrain/chunk.h"

namespace eye {

struct MeshedTile {
  ChunkMeta meta;  // all but texelErrorM, childCount and hasImagery
  ChunkMesh mesh;  // without skirts; vertex order as ChunkMesh says, triangles in cache order
};

// `toleranceM` is the level's, so that two neighbours simplify their common edge alike: each edge unit (a side, or half
// of a side where the columns double across it) is a function of the surface, the level and the tolerance alone.
// meta.geometricErrorM is the true maximum over the tile, rounding of positions included; it is at most toleranceM
// unless the tile runs out of 16-bit vertices.
MeshedTile meshTile(const ElevationSurface& surface, const TileKey& key, double toleranceM);

}  // namespace eye
