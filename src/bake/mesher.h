// A tile's mesh: a triangulated irregular network with a guaranteed maximum error against the bilinear surface.
#pragma once

#include "bake/edge_simplify.h"
#include "bake/elevation.h"
#include "terrain/chunk.h"

namespace eye {

struct MeshedTile {
  ChunkMeta meta;  // all but texelErrorM, childCount and hasImagery
  ChunkMesh mesh;  // without skirts; vertex order as ChunkMesh says, triangles in clusters
};

// Two neighbours simplify their common edge alike: each edge unit (a side, or half of a side where the columns double
// across it) is a function of the surface, the level and the lesser of both tiles' tolerances alone.
// meta.geometricErrorM is the true maximum over the tile, rounding of positions included; it is at most the tile's
// tolerance unless the tile runs out of 16-bit vertices, or the ground is so steep (a wall, a source that ends without
// a fade) that rounding to the lattice, sideways, is more than that. A bilinear cell whose corners are twisted by d
// takes about d / (4 toleranceM) vertices: tolerances far below the twist of the posts cost more triangles than there
// are posts. Thread: any number at once.
MeshedTile meshTile(const ElevationSurface& surface, const TileKey& key, const TileTolerance& toleranceM);
// The same for all tiles of the level.
MeshedTile meshTile(const ElevationSurface& surface, const TileKey& key, double toleranceM);

}  // namespace eye
