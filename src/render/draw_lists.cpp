#include "render/draw_lists.h"

#include <algorithm>
#include <bit>

#include "render/frame_data.h"

namespace eye {
namespace {

// More chunks than a view of mountains draws at 1 pixel (50 to 500).
constexpr size_t kFirstCapacity = 1024;
constexpr size_t kCommandsPerChunk = 5;  // a surface and four skirts
// How far a skirt's lower rim may lie from the surface, in its depths: down, and outwards of both sides at a corner.
constexpr float kSkirtReach = 1 + 2 * static_cast<float>(EYE_SKIRT_FLARE);

vk::DrawIndexedIndirectCommand commandOf(const ChunkDraw& draw, uint32_t firstIndex, uint32_t indexCount,
                                         uint32_t instance) {
  return {indexCount, 1, firstIndex, static_cast<int32_t>(draw.gpu.vertexOffset), instance};
}

shader::CullBox eyeBoxOf(const OrientedBox& box, const Vec3d& eyeEcefM) {
  const auto& axes = box.halfAxesEcefM;
  return {glm::vec3(box.centreEcefM - eyeEcefM), glm::vec3(axes[0]), glm::vec3(axes[1]), glm::vec3(axes[2])};
}

}  // namespace

DrawLists::DrawLists(GpuDevices gpus) {
  reserve(gpus, kFirstCapacity);
}

void DrawLists::reserve(GpuDevices gpus, size_t chunks) {
  if (chunks <= capacity_) return;
  using Use = vk::BufferUsageFlagBits;
  capacity_ = std::bit_ceil(chunks);
  draws_ = createBuffers(gpus, capacity_ * (1 + kCommandsPerChunk) * sizeof(shader::DrawData), Use::eVertexBuffer,
                         MemoryUse::upload);
  commands_.clear();
  for (const auto& gpu : gpus)
    commands_.push_back(createBuffer(*gpu, capacity_ * kCommandsPerChunk * sizeof(vk::DrawIndexedIndirectCommand),
                                     Use::eIndirectBuffer, MemoryUse::upload));
}

void DrawLists::put(uint32_t number, vk::DrawIndexedIndirectCommand command, uint32_t bands) {
  for (const GpuBuffer& commands : commands_) {
    commands.as<vk::DrawIndexedIndirectCommand>()[number] =
        (bands & 1) != 0 ? command : vk::DrawIndexedIndirectCommand{};
    bands >>= 1;
  }
}

// The record of a surface is that of its chunk's number, those of skirts lie behind all of these, by their commands'
// numbers.
DrawRange DrawLists::writeRange(std::span<const ChunkDraw> draws, uint32_t firstChunk, uint32_t firstCommand,
                                const Vec3d& eyeEcefM, int textureSize, const BandTest& bandTest, DrawCounts& counts) {
  DrawRange range{.first = firstCommand};
  const auto records = draws_.front().as<shader::DrawData>();
  for (const ChunkDraw& draw : draws) {
    const uint32_t chunk = firstChunk + range.surfaces;
    records[chunk] = drawData(draw, eyeEcefM, textureSize);
    put(firstCommand + range.surfaces++, commandOf(draw, draw.gpu.firstIndex, draw.gpu.indexCount, chunk),
        bandTest.bandsOf(eyeBoxOf(draw.box, eyeEcefM)));
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
      put(command, commandOf(draw, draw.gpu.firstIndex + skirt.firstIndex, skirt.indexCount, own),
          bandTest.bandsOf(eyeBoxOf(draw.box, eyeEcefM), kSkirtReach * draw.skirtDepthM[side]));
      counts.skirtTriangles += skirt.indexCount / 3;
    }
  }
  return range;
}

DrawCounts DrawLists::write(std::span<const ChunkDraw> draws, size_t byVertex, const Vec3d& eyeEcefM, int textureSize,
                            const BandTest& bandTest) {
  EYE_CHECK(draws.size() <= capacity_);
  DrawCounts counts;
  counts.byVertex = writeRange(draws.first(byVertex), 0, 0, eyeEcefM, textureSize, bandTest, counts);
  counts.byPixel = writeRange(draws.subspan(byVertex), static_cast<uint32_t>(byVertex), counts.byVertex.count(),
                              eyeEcefM, textureSize, bandTest, counts);
  return counts;
}

}  // namespace eye
