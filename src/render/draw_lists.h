// The draws of a frame in memory that the GPU reads: an indirect command and a record for each surface and for each
// skirt that it needs, since skirts of one chunk are not equally deep. Owner thread: render.
#pragma once

#include "gpu/memory.h"
#include "render/bands.h"
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
  explicit DrawLists(GpuDevices gpus);
  // Makes room for so many chunks. Nothing may be in flight.
  void reserve(GpuDevices gpus, size_t chunks);
  // As partByHaze parts them: the first `byVertex` have haze by vertex.
  DrawCounts write(std::span<const ChunkDraw> draws, size_t byVertex, const Vec3d& eyeEcefM, int textureSize,
                   const BandTest& bandTest);

  // By device, that is by band: a band's commands draw nothing for what does not show there.
  const GpuBuffer& draws(size_t device = 0) const { return draws_[device]; }
  const GpuBuffer& commands(size_t device = 0) const { return commands_[device]; }

 private:
  DrawRange writeRange(std::span<const ChunkDraw> draws, uint32_t firstChunk, uint32_t firstCommand,
                       const Vec3d& eyeEcefM, int textureSize, const BandTest& bandTest, DrawCounts& counts);
  void put(uint32_t number, vk::DrawIndexedIndirectCommand command, uint32_t bands);

  size_t capacity_ = 0;
  std::vector<GpuBuffer> draws_, commands_;
};

}  // namespace eye
