// The height of the ground under a place, from the finest meshes of a database. Thread: one at a time.
#pragma once

#include <unordered_map>

#include "terrain/database.h"

namespace eye {

class GroundHeights {
 public:
  explicit GroundHeights(const DatabaseReader& reader) : reader_(reader) {}
  // Metres, geodetic. badData where the database is damaged.
  Result<double> heightM(const LatLon& at);

 private:
  struct Tile {
    ChunkMesh mesh;
    std::vector<double> heightsM;  // by vertex
  };
  Result<const Tile*> finestTile(const LatLon& at, TileKey& key);

  const DatabaseReader& reader_;
  std::unordered_map<TileKey, Tile> tiles_;
};

// Geodetic positions of a mesh's vertices.
std::vector<Geodetic> vertexPositions(const ChunkMesh& mesh, const ChunkMeta& meta);

}  // namespace eye
