// Small chunks made by hand for the tests of blobs and database: hills of a few hundred metres on any tile.
#pragma once

#include <vector>

#include "terrain/chunk.h"
#include "terrain/database.h"

namespace eye {

// The loop and an interior grid of an ordinary cell, a fan about the pole in a pole cell; `edges` segments a side.
struct SyntheticMesh {
  ChunkMesh mesh;
  ChunkMeta meta;  // everything but texelErrorM and childCount; geometricErrorM halves from level to level
};
SyntheticMesh syntheticMesh(const TileKey& key, int edges);

// A smooth picture with some noise, size * size * 3 bytes, another one for each seed.
std::vector<uint8_t> syntheticPicture(int size, uint32_t seed);

// Mesh, imagery where the tile must have it or `hasImagery` asks for it, and believable metadata.
StoredChunk syntheticChunk(const TileKey& key, int textureSize, bool hasImagery);

}  // namespace eye
