// From the database to chunks that are ready for the GPU: read, decode, skirts, mip chains. Thread: the reader's owner.
#pragma once

#include <functional>
#include <vector>

#include "paging/terrain_cache.h"
#include "terrain/database.h"

namespace eye {

// What is paged as one: all children of a node, in the order of TileKey::children.
struct ChunkGroup {
  TileKey parent;
  std::vector<LoadedChunk> chunks;
  size_t bytes() const;
};

// What loading took.
struct LoadCost {
  double readS = 0, decodeS = 0;
  uint64_t fileBytes = 0, decodedBytes = 0;
};

// Any damage is badData or notFound with the tile's name.
// `cost`, where given, is added to.
Result<LoadedChunk> loadChunk(const DatabaseReader& reader, const TileKey& key, LoadCost* cost = nullptr);
Result<ChunkGroup> loadGroup(const DatabaseReader& reader, const TileKey& parent, LoadCost* cost = nullptr);

}  // namespace eye
