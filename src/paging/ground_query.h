// Heights and lines of sight in the finest terrain of a database, whatever is drawn: double precision, on triangles.
// One thread at a time.
#pragma once

#include <list>
#include <memory>
#include <optional>
#include <unordered_map>

#include "paging/triangle_grid.h"
#include "terrain/database.h"

namespace eye {

struct GroundHit {
  Geodetic position;
  Vec3d normalEcef{};  // of the triangle; unit, outwards
};

class GroundQuery {
 public:
  static Result<GroundQuery> open(const std::string& databasePath);

  // The ground under or over a point.
  Result<GroundHit> under(double latDeg, double lonDeg);
  // The first triangle on the way between two points, either side of it. An error where the way leads through more
  // chunks than kMostChunks.
  Result<std::optional<GroundHit>> between(const Vec3d& fromEcefM, const Vec3d& toEcefM);

  static constexpr int kMostChunks = 4000;  // looked at for one line of sight, by their boxes

 private:
  // A leaf's triangles, relative to `originEcefM`.
  struct Mesh {
    Vec3d originEcefM{};
    double minHeightM = 0, maxHeightM = 0;
    std::vector<glm::vec3> positionsM;
    std::vector<uint16_t> indices;
    TriangleGrid grid;
    size_t bytes() const {
      return positionsM.size() * sizeof(glm::vec3) + indices.size() * sizeof(uint16_t) + grid.bytes();
    }
  };
  struct Kept {
    Mesh mesh;
    std::list<uint64_t>::iterator use;
  };

  explicit GroundQuery(DatabaseReader reader) : reader_(std::move(reader)) {}
  // Valid until the next call.
  Result<const ChunkMeta*> metaOf(const TileKey& key);
  Result<const Mesh*> meshOf(const TileKey& key);
  const Mesh* keptMeshOf(const TileKey& key);
  // The leaf that holds a place.
  Result<std::pair<TileKey, const Mesh*>> leafAt(double latDeg, double lonDeg);

  DatabaseReader reader_;
  std::unordered_map<uint64_t, ChunkMeta> metas_;
  std::unordered_map<uint64_t, Kept> meshes_;
  std::list<uint64_t> uses_;  // of meshes, the newest first
  size_t meshBytes_ = 0;
  int leafLevel_ = 0;  // of the last height: the next is asked nearby, mostly
};

}  // namespace eye
