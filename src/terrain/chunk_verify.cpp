#include "terrain/chunk_verify.h"

#include "terrain/clusters.h"

namespace eye {
namespace {

// Bounds are rounded outwards; what is left is the rounding of doubles of Earth's size.
constexpr double kToleranceM = 1e-3;

bool boxHolds(const OrientedBox& box, const Vec3d& pointEcefM) {
  const Vec3d offset = pointEcefM - box.centreEcefM;
  for (const Vec3d& axis : box.halfAxesEcefM) {
    const double halfM = glm::length(axis);
    const double alongM = halfM > 0 ? std::abs(glm::dot(offset, axis)) / halfM : 0.0;
    if (alongM > halfM + kToleranceM) return false;
  }
  return true;
}

Result<void> checkClusters(const ChunkMesh& mesh, const ChunkMeta& meta) {
  for (const ChunkCluster& cluster : mesh.clusters) {
    const OrientedBox box = clusterBox(meta.box, cluster);
    for (size_t i = cluster.firstIndex; i < cluster.firstIndex + cluster.indexCount; ++i) {
      const ChunkVertex& vertex = mesh.vertices[mesh.indices[i]];
      const LatticePoint point = meta.originLattice + LatticePoint(vertex.x, vertex.y, vertex.z);
      if (!boxHolds(box, ecefFromLattice(point, meta.stepM()))) {
        return fail(ErrorKind::badData, "a triangle lies outside its cluster's box");
      }
    }
    if (!coneHolds(mesh, cluster))
      return fail(ErrorKind::badData, "a triangle's normal lies outside its cluster's cone");
  }
  return {};
}

}  // namespace

Result<void> checkContents(const StoredChunk& chunk, int textureSize) {
  const ChunkMeta& meta = chunk.meta;
  const Result<ChunkMesh> mesh = decodeMesh(chunk.mesh, meta.key);
  if (!mesh) return tl::unexpected(mesh.error());
  if (meta.hasImagery) {
    if (const auto imagery = decodeImagery(chunk.imagery, textureSize); !imagery) {
      return tl::unexpected(imagery.error());
    }
  }
  for (const ChunkVertex& vertex : mesh->vertices) {
    const LatticePoint point = meta.originLattice + LatticePoint(vertex.x, vertex.y, vertex.z);
    const Vec3d pointEcefM = ecefFromLattice(point, meta.stepM());
    if (glm::distance(pointEcefM, meta.sphereCentreEcefM) > meta.sphereRadiusM + kToleranceM) {
      return fail(ErrorKind::badData, "a vertex lies outside its bounding sphere");
    }
    if (!boxHolds(meta.box, pointEcefM)) return fail(ErrorKind::badData, "a vertex lies outside its bounding box");
    const double heightM = geodeticFromEcef(pointEcefM).altM;
    if (heightM < meta.minHeightM - kToleranceM || heightM > meta.maxHeightM + kToleranceM) {
      return fail(ErrorKind::badData, "a vertex lies outside its heights");
    }
  }
  return checkClusters(*mesh, meta);
}

}  // namespace eye
