// The draws of a frame in memory that the GPU reads: an indirect command and a record for each surface and for each
// skirt that it needs, since skirts of one chunk are not equally deep. Owner thread: render.
#pragma once

#include "gpu/memory.h"
#include "render/renderer.h"
#include "shared/types.h"

namespace eye {

// Commands behind one another, the surfaces' before the skirts', most of which are hidden then.
struct DrawRange {
  uint32_t first = 0, surfaces = 0, skirts = 0;
  uint32_t firstSkirt() const { return first + surfaces; }
  uint32_t count() const { return surfaces + skirts; }
};

struct DrawCounts {
  DrawRange byVertex, byPixel;  // by how haze is drawn
  uint32_t draws() const { return byVertex.count() + byPixel.count(); }
  uint32_t skirts() const { return byVertex.skirts + byPixel.skirts; }
  uint64_t surfaceTriangles = 0, skirtTriangles = 0;
  uint64_t vertices = 0;  // those of the chunks drawn
};

class DrawLists {
 public:
  explicit DrawLists(const GpuDevice& gpu);
  // Makes room for so many chunks. Nothing may be in flight.
  void reserve(const GpuDevice& gpu, size_t chunks);
  // As partByHaze parts them: the first `byVertex` have haze by vertex.
  DrawCounts write(std::span<const ChunkDraw> draws, size_t byVertex, const Vec3d& eyeEcefM, int textureSize);

  const GpuBuffer& draws() const { return draws_; }
  const GpuBuffer& commands() const { return commands_; }

 private:
  DrawRange writeRange(std::span<const ChunkDraw> draws, uint32_t firstChunk, uint32_t firstCommand,
                       const Vec3d& eyeEcefM, int textureSize, DrawCounts& counts);

  size_t capacity_ = 0;
  GpuBuffer draws_, commands_;
};

}  // namespace eye
