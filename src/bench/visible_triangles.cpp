#include "bench/visible_triangles.h"

#include "bench/drawn_triangles.h"
#include "bench/triangle_ids.h"

namespace eye {
namespace {

constexpr size_t kChunksKept = 4096;  // some 100 KB each

void drawRun(const ChunkMesh& mesh, const ChunkMeta& meta, const View& view, const ChunkCluster& run, TriangleIds& ids,
             uint32_t& id) {
  const Vec3d originM = ecefFromLattice(meta.originLattice, meta.stepM()) - view.eyeEcefM;
  const auto at = [&](size_t index) {
    const ChunkVertex& v = mesh.vertices[mesh.indices[index]];
    return originM + Vec3d(v.x, v.y, v.z) * meta.stepM();
  };
  for (size_t i = run.firstIndex; i < run.firstIndex + run.indexCount; i += 3)
    ids.draw(at(i), at(i + 1), at(i + 2), id++);
}

}  // namespace

Result<const VisibleTriangles::Chunk*> VisibleTriangles::chunkOf(const TileKey& key) {
  if (const auto known = chunks_.find(key); known != chunks_.end()) return &known->second;
  if (chunks_.size() >= kChunksKept) chunks_.clear();
  Result<StoredChunk> stored = reader_.read(key);
  if (!stored) return tl::unexpected(stored.error());
  Result<ChunkMesh> mesh = decodeMesh(stored->mesh, key);
  if (!mesh) return tl::unexpected(mesh.error());
  return &chunks_.emplace(key, Chunk{stored->meta, std::move(*mesh)}).first->second;
}

Result<size_t> VisibleTriangles::count(ImageGenerator& generator, bool isCulled) {
  std::vector<uint32_t> fates;
  if (isCulled) fates = fatesInPool(generator.renderer().readCulling());
  TriangleIds ids(generator.view());
  uint32_t id = 0;
  for (const DrawnChunk& drawn : generator.selection().draws) {
    const CacheNode& node = generator.terrain().node(drawn.node);
    const Result<const Chunk*> chunk = chunkOf(node.meta.key);
    if (!chunk) return tl::unexpected(chunk.error());
    size_t inPool = node.gpu.clusterOffset;
    for (const ChunkCluster& cluster : (*chunk)->mesh.clusters) {
      const bool isDrawn = !isCulled || (fates[inPool] & (EYE_FATE_EARLY | EYE_FATE_LATE)) != 0;
      ++inPool;
      if (isDrawn) drawRun((*chunk)->mesh, (*chunk)->meta, generator.view(), cluster, ids, id);
    }
  }
  return ids.visible();
}

}  // namespace eye
