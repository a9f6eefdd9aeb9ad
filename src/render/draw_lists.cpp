#include "render/draw_lists.h"

#include <algorithm>
#include <bit>

#include "render/frame_data.h"

namespace eye {
namespace {

// More chunks than a view of mountains draws at 1 pixel (50 to 500).
constexpr size_t kFirstCapacity = 1024;
constexpr size_t kCommandsPerChunk = 5;  // a surface and four skirts

vk::DrawIndexedIndirectCommand commandOf(const ChunkDraw& draw, uint32_t firstIndex, uint32_t indexCount,
                                         uint32_t instance) {
  return {indexCount, 1, firstIndex, static_cast<int32_t>(draw.gpu.vertexOffset), instance};
}

}  // namespace

DrawLists::DrawLists(const GpuDevice& gpu) {
  reserve(gpu, kFirstCapacity);
}

void DrawLists::reserve(const GpuDevice& gpu, size_t chunks) {
  if (chunks <= capacity_) return;
  using Use = vk::BufferUsageFlagBits;
  capacity_ = std::bit_ceil(chunks);
  draws_ = createBuffer(gpu, capacity_ * kCommandsPerChunk * sizeof(shader::DrawData), Use::eVertexBuffer,
                        MemoryUse::upload);
  commands_ = createBuffer(gpu, capacity_ * kCommandsPerChunk * sizeof(vk::DrawIndexedIndirectCommand),
                           Use::eIndirectBuffer, MemoryUse::upload);
}

DrawCounts DrawLists::write(std::span<const ChunkDraw> draws, const Vec3d& eyeEcefM, int textureSize) {
  EYE_CHECK(draws.size() <= capacity_);
  DrawCounts counts;
  const auto records = draws_.as<shader::DrawData>();
  const auto commands = commands_.as<vk::DrawIndexedIndirectCommand>();
  for (uint32_t i = 0; i < draws.size(); ++i) {
    const ChunkDraw& draw = draws[i];
    records[i] = drawData(draw, eyeEcefM, textureSize);
    commands[counts.surfaces++] = commandOf(draw, draw.gpu.firstIndex, draw.gpu.indexCount, i);
    counts.surfaceTriangles += draw.gpu.indexCount / 3;
    counts.vertices += draw.gpu.vertexCount;
  }
  for (uint32_t i = 0; i < draws.size(); ++i) {
    if (draws[i].skirtMask == 0) continue;
    shader::DrawData record = drawData(draws[i], eyeEcefM, textureSize);  // again: the GPU's memory is slow to read
    for (size_t side = 0; side < 4; ++side) {
      const SkirtRange& skirt = draws[i].skirts[side];
      if ((draws[i].skirtMask & (1 << side)) == 0 || skirt.indexCount == 0) continue;
      const uint32_t own = counts.surfaces + counts.skirts++;
      record.skirtDepthM = draws[i].skirtDepthM[side];
      records[own] = record;
      commands[own] = commandOf(draws[i], draws[i].gpu.firstIndex + skirt.firstIndex, skirt.indexCount, own);
      counts.skirtTriangles += skirt.indexCount / 3;
    }
  }
  return counts;
}

}  // namespace eye
