// How many of the triangles that a generator drew its picture shows. Owner thread: render.
#pragma once

#include <unordered_map>

#include "app/image_generator.h"
#include "terrain/database.h"

namespace eye {

class VisibleTriangles {
 public:
  explicit VisibleTriangles(const DatabaseReader& reader) : reader_(reader) {}
  // Of the last frame, of surfaces (skirts show in cracks alone). `isCulled`: it was drawn with a depth map, so only
  // the clusters that its passes drew are looked at.
  Result<size_t> count(ImageGenerator& generator, bool isCulled);

 private:
  struct Chunk {
    ChunkMeta meta;
    ChunkMesh mesh;
  };
  Result<const Chunk*> chunkOf(const TileKey& key);

  const DatabaseReader& reader_;
  std::unordered_map<TileKey, Chunk> chunks_;
};

}  // namespace eye
