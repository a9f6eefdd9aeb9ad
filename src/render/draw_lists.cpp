#include "render/draw_lists.h"

#include <algorithm>
#include <bit>

#include "render/frame_data.h"

namespace eye {
namespace {

// More chunks than a view of mountains draws at 1 pixel (50 to 500).
constexpr size_t kFirstCapacity = 4096;
constexpr size_t kCommandsPerChunk = 5;  // a surface and four skirts

void append(std::span<vk::DrawIndexedIndirectCommand> commands, const ChunkDraw& draw, uint32_t firstIndex,
            uint32_t indexCount, uint32_t instance, DrawCounts& counts) {
  commands[counts.commands++] =
      vk::DrawIndexedIndirectCommand(indexCount, 1, firstIndex, static_cast<int32_t>(draw.gpu.vertexOffset), instance);
  counts.triangles += indexCount / 3;
}

}  // namespace

DrawLists::DrawLists(const GpuDevice& gpu) {
  texelSizes_ =
      createBuffer(gpu, EYE_MAX_LAYERS * sizeof(float), vk::BufferUsageFlagBits::eStorageBuffer, MemoryUse::upload);
  std::fill_n(texelSizes_.as<float>().begin(), EYE_MAX_LAYERS, 1.0f);
  reserve(gpu, kFirstCapacity);
}

bool DrawLists::reserve(const GpuDevice& gpu, size_t chunks) {
  if (chunks <= capacity_) return false;
  capacity_ = std::bit_ceil(chunks);
  draws_ = createBuffer(gpu, capacity_ * sizeof(shader::DrawData), vk::BufferUsageFlagBits::eStorageBuffer,
                        MemoryUse::upload);
  commands_ = createBuffer(gpu, capacity_ * kCommandsPerChunk * sizeof(vk::DrawIndexedIndirectCommand),
                           vk::BufferUsageFlagBits::eIndirectBuffer, MemoryUse::upload);
  return true;
}

DrawCounts DrawLists::write(std::span<const ChunkDraw> draws, const Vec3d& eyeEcefM, int textureSize) {
  EYE_CHECK(draws.size() <= capacity_);
  DrawCounts counts;
  const auto records = draws_.as<shader::DrawData>();
  const auto commands = commands_.as<vk::DrawIndexedIndirectCommand>();
  const auto texelSizes = texelSizes_.as<float>();
  for (uint32_t i = 0; i < draws.size(); ++i) {
    const ChunkDraw& draw = draws[i];
    EYE_CHECK(draw.textureLayer < EYE_MAX_LAYERS);
    records[i] = drawData(draw, eyeEcefM, textureSize);
    texelSizes[draw.textureLayer] = draw.texelM;
    append(commands, draw, draw.gpu.firstIndex, draw.gpu.indexCount, i, counts);
    counts.vertices += draw.gpu.vertexCount;
  }
  for (uint32_t i = 0; i < draws.size(); ++i) {
    for (size_t side = 0; side < 4; ++side) {
      const SkirtRange& skirt = draws[i].skirts[side];
      if ((draws[i].skirtMask & (1 << side)) == 0 || skirt.indexCount == 0) continue;
      append(commands, draws[i], draws[i].gpu.firstIndex + skirt.firstIndex, skirt.indexCount, i, counts);
    }
  }
  return counts;
}

}  // namespace eye
