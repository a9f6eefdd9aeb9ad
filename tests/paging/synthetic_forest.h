// A small made-up globe for the paging tests: smooth hills, every chunk a fan with points inside, errors that halve
// with each level. Nothing of it is drawn; bounds, errors and horizon points are honest.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "geo/view.h"
#include "paging/terrain_cache.h"
#include "terrain/database.h"

namespace eye {

inline constexpr int kForestTextureSize = 16;

double forestHeightM(double latDeg, double lonDeg);  // 0 to 1600
double forestErrorM(int level);                      // more than a chunk's mesh may be off

struct ForestChunk {
  ChunkMeta meta;
  ChunkMesh mesh;                    // without skirts
  std::vector<Vec3d> verticesEcefM;  // of the mesh
};
// `isRefined`: whether the bake went on below it.
ForestChunk makeForestChunk(const TileKey& key, bool isRefined, bool hasImagery);

// Whether chunks at this key have children; the forest's shape.
using IsRefined = std::function<bool(const TileKey&)>;
IsRefined everywhereTo(int level);
// Everywhere to `globalLevel`, and to `level` where a cell holds the point or lies within its own size of it.
IsRefined around(double latDeg, double lonDeg, int globalLevel, int level);
bool ownImagery(const TileKey& key);  // level 4 and coarser, and about the poles

// Inserts `key`'s children and theirs wherever `isResident` says that a node has its children resident.
TerrainCache makeForest(const IsRefined& isRefined, const IsRefined& isResident);

// A terrain database in a file of its own, removed when the object goes.
class ForestFile {
 public:
  explicit ForestFile(const IsRefined& isRefined);
  ~ForestFile();
  ForestFile(const ForestFile&) = delete;
  ForestFile& operator=(const ForestFile&) = delete;
  const std::string& path() const { return path_; }
  // Overwrites the middle of the chunk's mesh where it lies in the file.
  void damage(const TileKey& key) const;

 private:
  std::string path_;
};

// Anywhere on Earth from 10 m above ground to far out in space, most of them low, looking anywhere.
View randomView(uint32_t seed);

}  // namespace eye
