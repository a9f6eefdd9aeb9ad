// Paper 004's levels and blocks over a database: which level its equation (7) gives a distance, and which of that
// level's blocks a view shows.
#pragma once

#include <unordered_map>

#include "geo/view.h"
#include "paging/horizon.h"
#include "terrain/database.h"

namespace eye {

// Equation (7). `windowPx`: of the window's side, `blockPx`: that a block is to have (L_d), `fovDeg`: the full angle.
// The distance is the paper's d_far - R_e, from the surface. 0 to kMaxLevel.
int levelByDistance(double windowPx, double blockPx, double fovDeg, double distanceM);

struct BlockCounts {
  uint64_t blocks = 0, visible = 0;
  double culledShare() const { return blocks > 0 ? 1 - static_cast<double>(visible) / static_cast<double>(blocks) : 0; }
};

// Thread: one at a time.
class GlobeBlocks {
 public:
  explicit GlobeBlocks(const DatabaseReader& reader) : reader_(reader) {}
  // All blocks of a level, tested as the selection tests chunks, by view frustum and horizon. A block that neither test
  // hides is visible when one of its descendants, up to a few levels down, is: these are what would be drawn of it.
  // Where the database ends above the level, the block counts as its ancestor does.
  Result<BlockCounts> count(int level, const View& view, HorizonTest test);

 private:
  Result<const ChunkMeta*> metaOf(const TileKey& key);
  Result<bool> isVisible(const TileKey& key, int deeper);
  Result<double> lowestM();

  const DatabaseReader& reader_;
  std::unordered_map<TileKey, ChunkMeta> metas_;
  std::optional<double> lowestM_;
  // Of the count at hand.
  std::optional<Horizon> horizon_;
  HorizonTest test_ = HorizonTest::ellipsoid;
  Vec3d eyeEcefM_{};
  FrustumPlanes planes_{};
};

}  // namespace eye
