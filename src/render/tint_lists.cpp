#include "render/tint_lists.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "render/frame_data.h"

namespace eye {
namespace {

constexpr float kStrength = 0.62f;  // of the tint over the ground's own colour
constexpr size_t kFirstCapacity = 1024;

}  // namespace

glm::vec3 tintOfLevel(int level) {
  // Neighbouring levels are far apart in hue.
  constexpr std::array<std::array<float, 3>, 8> kColours{{{0.90f, 0.10f, 0.29f},
                                                          {0.24f, 0.71f, 0.29f},
                                                          {0.26f, 0.39f, 0.85f},
                                                          {1.00f, 0.88f, 0.10f},
                                                          {0.57f, 0.12f, 0.71f},
                                                          {0.27f, 0.83f, 0.83f},
                                                          {0.96f, 0.51f, 0.19f},
                                                          {0.94f, 0.20f, 0.90f}}};
  const auto& colour = kColours[static_cast<size_t>(level) % kColours.size()];
  return {colour[0], colour[1], colour[2]};
}

glm::vec3 tintOfFate(uint32_t why) {
  switch (why) {
    case EYE_FATE_OUTSIDE:
      return {0.55f, 0.55f, 0.55f};
    case EYE_FATE_BACK_FACING:
      return {0.15f, 0.35f, 1.00f};
    case EYE_FATE_OCCLUDED:
      return {1.00f, 0.12f, 0.10f};
    default:
      return {0.15f, 0.85f, 0.20f};
  }
}

void FateMemory::forget() {
  runs_.clear();
  clusters_.clear();
}

void FateMemory::remember(const GpuDevice& gpu, const ChunkPools& pools, const CullLists& lists) {
  forget();
  if (lists.candidateCount() == 0) return;
  const auto records = readBuffer<shader::ClusterRecord>(gpu, pools.clusterBuffer(), pools.clusterCapacity());
  const auto candidates = lists.candidatesBuffer().as<const shader::CullCandidate>().first(lists.candidateCount());
  const auto fates = lists.fatesBuffer().as<const uint32_t>();
  uint32_t chunk = ~0u;
  for (uint32_t i = 0; i < candidates.size(); ++i) {
    if (candidates[i].chunk != chunk) runs_.push_back({candidates[i].cluster, i, 0});
    chunk = candidates[i].chunk;
    ++runs_.back().count;
    const shader::ClusterRecord& record = records[candidates[i].cluster];
    clusters_.push_back({record.firstIndex, record.indexCount, fates[i] & EYE_FATE_WHY});
  }
  std::ranges::sort(runs_, {}, &Run::clusterOffset);
}

std::span<const FateMemory::Cluster> FateMemory::clustersOf(const GpuChunk& chunk) const {
  const auto run = std::ranges::lower_bound(runs_, chunk.clusterOffset, {}, &Run::clusterOffset);
  if (run == runs_.end() || run->clusterOffset != chunk.clusterOffset || run->count != chunk.clusterCount) return {};
  const std::span<const Cluster> clusters = std::span(clusters_).subspan(run->begin, run->count);
  uint32_t next = chunk.firstIndex;
  for (const Cluster& cluster : clusters) {
    if (cluster.firstIndex != next) return {};
    next += cluster.indexCount;
  }
  if (next != chunk.firstIndex + chunk.indexCount) return {};
  return clusters;
}

void TintLists::add(shader::DrawData record, const glm::vec4& tint, const GpuChunk& chunk, uint32_t firstIndex,
                    uint32_t indexCount) {
  for (int i = 0; i < 4; ++i) record.outwardEcef[i].w = tint[i];
  commandList_.push_back({indexCount, 1, firstIndex, static_cast<int32_t>(chunk.vertexOffset), count()});
  recordList_.push_back(record);
}

void TintLists::write(const GpuDevice& gpu, std::span<const ChunkDraw> draws, const Vec3d& eyeEcefM, int textureSize,
                      Tint tint, const FateMemory& fates) {
  recordList_.clear();
  commandList_.clear();
  const auto tintOf = [&](const ChunkDraw& draw) {  // of what has no fate
    return tint == Tint::level ? glm::vec4(tintOfLevel(draw.level), kStrength) : glm::vec4(0.0f);
  };
  for (const ChunkDraw& draw : draws) {
    const shader::DrawData record = drawData(draw, eyeEcefM, textureSize);
    const auto clusters = tint == Tint::fate ? fates.clustersOf(draw.gpu) : std::span<const FateMemory::Cluster>();
    if (clusters.empty()) add(record, tintOf(draw), draw.gpu, draw.gpu.firstIndex, draw.gpu.indexCount);
    for (size_t i = 0; i < clusters.size();) {
      uint32_t indexCount = 0;
      const FateMemory::Cluster& first = clusters[i];
      for (; i < clusters.size() && clusters[i].why == first.why; ++i) indexCount += clusters[i].indexCount;
      add(record, glm::vec4(tintOfFate(first.why), kStrength), draw.gpu, first.firstIndex, indexCount);
    }
  }
  for (const ChunkDraw& draw : draws) {
    if (draw.skirtMask == 0) continue;
    shader::DrawData record = drawData(draw, eyeEcefM, textureSize);
    for (size_t side = 0; side < 4; ++side) {
      const SkirtRange& skirt = draw.skirts[side];
      if ((draw.skirtMask & (1u << side)) == 0 || skirt.indexCount == 0) continue;
      record.skirtDepthM = draw.skirtDepthM[side];
      add(record, tintOf(draw), draw.gpu, draw.gpu.firstIndex + skirt.firstIndex, skirt.indexCount);
    }
  }
  if (commandList_.size() > capacity_) {
    capacity_ = std::bit_ceil(std::max(commandList_.size(), kFirstCapacity));
    using Use = vk::BufferUsageFlagBits;
    draws_ = createBuffer(gpu, capacity_ * sizeof(shader::DrawData), Use::eVertexBuffer, MemoryUse::upload);
    commands_ =
        createBuffer(gpu, capacity_ * sizeof(vk::DrawIndexedIndirectCommand), Use::eIndirectBuffer, MemoryUse::upload);
  }
  std::ranges::copy(recordList_, draws_.as<shader::DrawData>().begin());
  std::ranges::copy(commandList_, commands_.as<vk::DrawIndexedIndirectCommand>().begin());
}

}  // namespace eye
