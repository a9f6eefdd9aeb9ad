#include "bench/drawn_triangles.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "bench/triangle_ids.h"
#include "paging/chunk_loader.h"

namespace eye {
namespace {

constexpr size_t kChunksKept = 4096;  // some 20 KB each without their textures

// The surface's triangles in clusters that were drawn; without a depth map all of them.
// `clusters`: the chunk's, empty where all of it is drawn.
std::vector<TriangleFate> surfaceFates(const LoadedChunk& chunk, std::span<const TriangleBits> clusters) {
  std::vector<TriangleFate> fates(chunk.surfaceIndexCount / 3, TriangleFate::hidden);
  if (clusters.empty()) return fates;
  for (size_t i = 0; i < chunk.mesh.clusters.size(); ++i) {
    const ChunkCluster& cluster = chunk.mesh.clusters[i];
    for (size_t t = 0; t < cluster.indexCount / 3; ++t)
      if (clusters[i] != kAllTriangles && (t >= 64 || (clusters[i] >> t & 1) == 0))
        fates[cluster.firstIndex / 3 + t] = TriangleFate::notSubmitted;
  }
  return fates;
}

}  // namespace

uint64_t DrawnTriangles::count(TriangleFate fate) const {
  uint64_t sum = 0;
  for (const DrawnRun& run : runs) sum += static_cast<uint64_t>(std::ranges::count(run.fates, fate));
  return sum;
}

uint64_t DrawnTriangles::submitted() const {
  uint64_t sum = 0;
  for (const DrawnRun& run : runs) sum += run.fates.size();
  return sum - count(TriangleFate::notSubmitted);
}

CornerPlaces::CornerPlaces(const ChunkDraw& draw, const LoadedChunk& chunk, int skirtSide, const Vec3d& eyeEcefM)
    : draw_(draw),
      mesh_(chunk.mesh),
      originM_(ecefFromLattice(draw.originLattice, draw.stepM) - eyeEcefM),
      skirtDepthM_(skirtSide < 0 ? 0 : draw.skirtDepthM[static_cast<size_t>(skirtSide)]) {}

// As terrain.vert places it.
Vec3d CornerPlaces::operator[](size_t index) const {
  const ChunkVertex& v = mesh_.vertices[mesh_.indices[index]];
  const Vec3d at = originM_ + Vec3d(v.x, v.y, v.z) * draw_.stepM;
  if (v.skirtSides == 0) return at;
  Vec3d outward(0.0);
  for (size_t side = 0; side < 4; ++side)
    if ((v.skirtSides & (1 << side)) != 0) outward += Vec3d(draw_.outwardEcef[side]);
  return at + skirtDepthM_ * (EYE_SKIRT_FLARE * outward - Vec3d(draw_.upEcef));
}

Result<std::shared_ptr<const LoadedChunk>> ChunkShelf::chunk(const TileKey& key) {
  if (const auto known = chunks_.find(key); known != chunks_.end()) return known->second;
  Result<LoadedChunk> loaded = loadChunk(reader_, key);
  if (!loaded) return tl::unexpected(loaded.error());
  loaded->texels = {};
  if (chunks_.size() >= kChunksKept) chunks_.clear();
  return chunks_.emplace(key, std::make_shared<const LoadedChunk>(std::move(*loaded))).first->second;
}

std::vector<TriangleBits> drawnTrianglesInPool(const CullReadBack& culling) {
  std::vector<TriangleBits> drawn(culling.clusters.size());
  for (size_t i = 0; i < culling.candidates.size(); ++i) {
    if ((culling.fates[i] & (EYE_FATE_EARLY | EYE_FATE_LATE)) == 0) continue;
    const uint32_t cluster = culling.candidates[i].cluster;
    drawn[cluster] = culling.visibleTriangles.empty() ? kAllTriangles : culling.visibleTriangles[cluster];
  }
  return drawn;
}

std::vector<uint32_t> fatesInPool(const CullReadBack& culling) {
  std::vector<uint32_t> fates(culling.clusters.size());
  for (size_t i = 0; i < culling.candidates.size(); ++i) fates[culling.candidates[i].cluster] = culling.fates[i];
  return fates;
}

bool isOffScreen(const FrustumPlanes& planes, const std::array<Vec3d, 3>& corners) {
  for (size_t i = 0; i < planes.normalsEcef.size(); ++i) {
    const auto isBehind = [&](const Vec3d& corner) {
      return glm::dot(planes.normalsEcef[i], corner) < planes.offsetsM[i];
    };
    if (std::ranges::all_of(corners, isBehind)) return true;
  }
  return false;
}

Result<DrawnTriangles> drawnTriangles(ImageGenerator& generator, ChunkShelf& shelf) {
  const FrameInput input = generator.lastInput();
  std::vector<TriangleBits> drawnInPool;
  if (input.depthMapPx) drawnInPool = drawnTrianglesInPool(generator.renderer().readCulling());
  DrawnTriangles drawn;
  for (size_t i = 0; i < input.draws.size(); ++i) {
    const ChunkDraw& draw = input.draws[i];
    auto chunk = shelf.chunk(generator.terrain().node(generator.selection().draws[i].node).meta.key);
    if (!chunk) return tl::unexpected(chunk.error());
    const size_t clusters = (*chunk)->mesh.clusters.size();
    std::span<const TriangleBits> own;
    if (!drawnInPool.empty()) own = std::span(drawnInPool).subspan(draw.gpu.clusterOffset, clusters);
    drawn.runs.push_back({.draw = i, .skirtSide = -1, .firstIndex = 0, .fates = surfaceFates(**chunk, own)});
    for (int side = 0; side < 4; ++side) {
      const SkirtRange& skirt = draw.skirts[static_cast<size_t>(side)];
      if ((draw.skirtMask & (1 << side)) == 0 || skirt.indexCount == 0) continue;
      drawn.runs.push_back({.draw = i,
                            .skirtSide = side,
                            .firstIndex = skirt.firstIndex,
                            .fates = std::vector<TriangleFate>(skirt.indexCount / 3, TriangleFate::hidden)});
    }
    drawn.chunks.push_back(std::move(*chunk));
  }

  const FrustumPlanes planes = frustumPlanes(input.view);
  TriangleIds ids(input.view);
  std::vector<TriangleFate*> fateOf;  // by identity
  for (DrawnRun& run : drawn.runs) {
    const CornerPlaces at(input.draws[run.draw], *drawn.chunks[run.draw], run.skirtSide, input.view.eyeEcefM);
    for (size_t t = 0; t < run.fates.size(); ++t) {
      TriangleFate& fate = run.fates[t];
      if (fate == TriangleFate::notSubmitted) continue;
      const size_t first = run.firstIndex + 3 * t;
      const std::array<Vec3d, 3> corners{at[first], at[first + 1], at[first + 2]};
      if (isOffScreen(planes, corners)) {
        fate = TriangleFate::offScreen;
      } else if (glm::dot(glm::cross(corners[1] - corners[0], corners[2] - corners[0]), corners[0]) >= 0) {
        fate = TriangleFate::facingAway;
      } else {
        const bool covers = ids.draw(corners[0], corners[1], corners[2], static_cast<uint32_t>(fateOf.size()));
        if (!covers) fate = TriangleFate::betweenPixels;
        fateOf.push_back(&fate);
      }
    }
  }
  for (const uint32_t id : ids.visibleIds()) *fateOf[id] = TriangleFate::visible;
  drawn.terrainPx = ids.pixelsShown();
  return drawn;
}

}  // namespace eye
