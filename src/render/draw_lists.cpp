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
  draws_ = createBuffer(gpu, capacity_ * (1 + kCommandsPerChunk) * sizeof(shader::DrawData), Use::eVertexBuffer,
                        MemoryUse::upload);
  commands_ = createBuffer(gpu, capacity_ * kCommandsPerChunk * sizeof(vk::DrawIndexedIndirectCommand),
                           Use::eIndirectBuffer, MemoryUse::upload);
}

// The record of a surface is that of its chunk's number, those of skirts lie behind all of these, by their commands'
// numbers.
DrawRange DrawLists::writeRange(std::span<const ChunkDraw> draws, uint32_t firstChunk, uint32_t firstCommand,
                                const Vec3d& eyeEcefM, int textureSize, DrawCounts& counts) {
  DrawRange range{.first = firstCommand};
  const auto records = draws_.as<shader::DrawData>();
  const auto commands = commands_.as<vk::DrawIndexedIndirectCommand>();
  for (const ChunkDraw& draw : draws) {
    const uint32_t chunk = firstChunk + range.surfaces;
    records[chunk] = drawData(draw, eyeEcefM, textureSize);
    commands[firstCommand + range.surfaces++] = commandOf(draw, draw.gpu.firstIndex, draw.gpu.indexCount, chunk);
    counts.surfaceTriangles += draw.gpu.indexCount / 3;
    counts.vertices += draw.gpu.vertexCount;
  }
  for (const ChunkDraw& draw : draws) {
    if (draw.skirtMask == 0) continue;
    shader::DrawData record = drawData(draw, eyeEcefM, textureSize);  // again: the GPU's memory is slow to read
    for (size_t side = 0; side < 4; ++side) {
      const SkirtRange& skirt = draw.skirts[side];
      if ((draw.skirtMask & (1 << side)) == 0 || skirt.indexCount == 0) continue;
      const uint32_t command = range.firstSkirt() + range.skirts++;
      const uint32_t own = static_cast<uint32_t>(capacity_) + command;
      record.skirtDepthM = draw.skirtDepthM[side];
      records[own] = record;
      commands[command] = commandOf(draw, draw.gpu.firstIndex + skirt.firstIndex, skirt.indexCount, own);
      counts.skirtTriangles += skirt.indexCount / 3;
    }
  }
  return range;
}

DrawCounts DrawLists::write(std::span<const ChunkDraw> draws, size_t byVertex, const Vec3d& eyeEcefM, int textureSize) {
  EYE_CHECK(draws.size() <= capacity_);
  DrawCounts counts;
  counts.byVertex = writeRange(draws.first(byVertex), 0, 0, eyeEcefM, textureSize, counts);
  counts.byPixel = writeRange(draws.subspan(byVertex), static_cast<uint32_t>(byVertex), counts.byVertex.count(),
                              eyeEcefM, textureSize, counts);
  return counts;
}

}  // namespace eye
