// The draws of a frame in memory that the GPU reads: an indirect command and a record for each surface and for each
// skirt that it needs, since skirts of one chunk are not equally deep. Owner thread: render.
#pragma once

#include "gpu/memory.h"
#include "render/renderer.h"
#include "shared/types.h"

namespace eye {

struct DrawCounts {
  uint32_t surfaces = 0, skirts = 0;  // commands, the surfaces' first
  uint64_t surfaceTriangles = 0, skirtTriangles = 0;
  uint64_t vertices = 0;  // those of the chunks drawn
};

class DrawLists {
 public:
  explicit DrawLists(const GpuDevice& gpu);
  // Makes room for so many chunks. Nothing may be in flight.
  void reserve(const GpuDevice& gpu, size_t chunks);
  // Surfaces first, front to back, then the skirts, most of which are hidden then.
  DrawCounts write(std::span<const ChunkDraw> draws, const Vec3d& eyeEcefM, int textureSize);

  const GpuBuffer& draws() const { return draws_; }
  const GpuBuffer& commands() const { return commands_; }

 private:
  size_t capacity_ = 0;
  GpuBuffer draws_, commands_;
};

}  // namespace eye
