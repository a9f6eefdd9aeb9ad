#include "bench/globe_blocks.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace eye {
namespace {

constexpr double kEarthRadiusM = 6371000;  // R_e; the paper's 6,480 km is a misprint
// Levels below a block that are looked at: from an octant down to cells of 3 degrees, finer than what a disc's rim
// hides.
constexpr int kDeeper = 5;

bool isOutside(const ChunkMeta& meta, const Vec3d& eyeEcefM, const FrustumPlanes& planes) {
  const Vec3d centreM = meta.box.centreEcefM - eyeEcefM;
  for (size_t i = 0; i < planes.normalsEcef.size(); ++i) {
    const Vec3d& normal = planes.normalsEcef[i];
    double reachM = 2 * meta.geometricErrorM;  // descendants lie that near to the mesh
    for (const Vec3d& halfAxis : meta.box.halfAxesEcefM) reachM += std::abs(glm::dot(normal, halfAxis));
    if (glm::dot(normal, centreM) - planes.offsetsM[i] < -reachM) return true;
  }
  return false;
}

}  // namespace

int levelByDistance(double windowPx, double blockPx, double fovDeg, double distanceM) {
  const double ratio = std::numbers::pi * windowPx * kEarthRadiusM /
                       (blockPx * std::tan(radFromDeg(fovDeg) / 2) * std::max(distanceM, 1.0));
  return static_cast<int>(std::clamp(std::ceil(std::log2(ratio)) - 2, 0.0, static_cast<double>(kMaxLevel)));
}

Result<const ChunkMeta*> GlobeBlocks::metaOf(const TileKey& key) {
  if (const auto known = metas_.find(key); known != metas_.end()) return &known->second;
  const Result<ChunkMeta> meta = reader_.readMeta(key);
  if (!meta) return tl::unexpected(meta.error());
  return &metas_.emplace(key, *meta).first->second;
}

// The lowest ground, or a little below it: what the Earth that hides something must lie under.
Result<double> GlobeBlocks::lowestM() {
  if (lowestM_) return *lowestM_;
  double lowestM = 0;
  const Result<void> walked = reader_.forEach([&](const ChunkMeta& meta) -> Result<void> {
    if (meta.childCount == 0 || meta.key.level() >= kDeeper) {
      lowestM = std::min(lowestM, meta.minHeightM - meta.geometricErrorM);
    }
    return {};
  });
  if (!walked) return tl::unexpected(walked.error());
  return *(lowestM_ = lowestM);
}

Result<bool> GlobeBlocks::isVisible(const TileKey& key, int deeper) {
  const Result<const ChunkMeta*> found = metaOf(key);
  if (!found) return tl::unexpected(found.error());
  const ChunkMeta& meta = **found;
  if (isOutside(meta, eyeEcefM_, planes_) || horizon_->hides(meta, test_)) return false;
  if (deeper == 0 || meta.childCount == 0) return true;
  for (const TileKey& child : key.children()) {
    const Result<bool> visible = isVisible(child, deeper - 1);
    if (!visible || *visible) return visible;
  }
  return false;
}

Result<BlockCounts> GlobeBlocks::count(int level, const View& view, HorizonTest test) {
  const Result<double> lowest = lowestM();
  if (!lowest) return tl::unexpected(lowest.error());
  horizon_.emplace(view.eyeEcefM, -*lowest);
  test_ = test;
  eyeEcefM_ = view.eyeEcefM;
  planes_ = frustumPlanes(view);
  // Down to the level, with the number of its blocks that each tile stands for.
  struct Standing {
    TileKey key;
    uint64_t blocks;
  };
  std::vector<Standing> tiles;
  for (int octant = 0; octant < kOctants; ++octant) tiles.push_back({TileKey::octantRoot(octant), 1});
  for (int above = 0; above < level; ++above) {
    std::vector<Standing> finer;
    for (const Standing& tile : tiles) {
      const Result<const ChunkMeta*> meta = metaOf(tile.key);
      if (!meta) return tl::unexpected(meta.error());
      const bool ends = tile.key.level() < above || (*meta)->childCount == 0;
      if (ends) {
        // A pole cell has three children, one of them a pole cell again: 4 n - 1 blocks.
        finer.push_back({tile.key, 4 * tile.blocks - (tile.key.isPolar() ? 1 : 0)});
        continue;
      }
      for (const TileKey& child : tile.key.children()) finer.push_back({child, 1});
    }
    tiles = std::move(finer);
  }
  BlockCounts counts;
  for (const Standing& tile : tiles) {
    const Result<bool> visible = isVisible(tile.key, kDeeper);
    if (!visible) return tl::unexpected(visible.error());
    counts.blocks += tile.blocks;
    if (*visible) counts.visible += tile.blocks;
  }
  return counts;
}

}  // namespace eye
