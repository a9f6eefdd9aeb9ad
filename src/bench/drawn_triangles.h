// The triangles that a picture was drawn from, one by one, and what became of each. Owner thread: render.
#pragma once

#include <unordered_map>
#include <vector>

#include "app/image_generator.h"
#include "render/triangle_cull.h"
#include "terrain/database.h"

namespace eye {

// In the order in which a rasteriser sorts them out: each is also none of those before it.
enum class TriangleFate : uint8_t {
  notSubmitted,  // in a cluster that culling left out
  offScreen,     // behind one plane of the frustum with all corners
  facingAway,
  betweenPixels,  // covers no pixel's centre
  hidden,         // something nearer covers all that it does
  visible,        // shows at least one pixel
};

// A run of a chunk's triangles that a draw may have: its surface, or one side's skirt.
struct DrawnRun {
  size_t draw = 0;  // of the FrameInput's list
  int skirtSide = -1;
  uint32_t firstIndex = 0;  // of the chunk's mesh
  std::vector<TriangleFate> fates;
};

struct DrawnTriangles {
  std::vector<std::shared_ptr<const LoadedChunk>> chunks;  // by draw
  std::vector<DrawnRun> runs;                              // a draw's surface, then its skirts, by draw
  uint64_t terrainPx = 0;                                  // pixels that show a triangle
  uint64_t count(TriangleFate fate) const;
  uint64_t submitted() const;
};

// Corners relative to the eye, ecef; indices into chunk.mesh.indices.
class CornerPlaces {
 public:
  // `skirtSide`: -1 for the surface.
  CornerPlaces(const ChunkDraw& draw, const LoadedChunk& chunk, int skirtSide, const Vec3d& eyeEcefM);
  Vec3d operator[](size_t index) const;

 private:
  const ChunkDraw& draw_;
  const ChunkMesh& mesh_;
  Vec3d originM_;  // of the chunk from the eye
  double skirtDepthM_;
};

// Keeps the chunks that it has read.
class ChunkShelf {
 public:
  explicit ChunkShelf(const DatabaseReader& reader) : reader_(reader) {}
  Result<std::shared_ptr<const LoadedChunk>> chunk(const TileKey& key);

 private:
  const DatabaseReader& reader_;
  std::unordered_map<TileKey, std::shared_ptr<const LoadedChunk>> chunks_;
};

// Of the generator's last frame. A pixel shows the triangle that is nearest at its centre.
Result<DrawnTriangles> drawnTriangles(ImageGenerator& generator, ChunkShelf& shelf);

// What the last frame's culling made of each cluster, by its place in the renderer's pool (GpuChunk::clusterOffset and
// on): the renderer takes draws in an order of its own.
std::vector<uint32_t> fatesInPool(const CullReadBack& culling);

// Which triangles of each cluster of the pool it has drawn, of a still eye: those that showed, where the CPU culls.
std::vector<TriangleBits> drawnTrianglesInPool(const CullReadBack& culling);

// Behind one plane of the frustum with all corners, which are relative to the eye.
bool isOffScreen(const FrustumPlanes& planes, const std::array<Vec3d, 3>& corners);

}  // namespace eye
