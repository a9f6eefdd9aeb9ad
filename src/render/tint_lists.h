// The draws of the debug views that colour terrain: by level of detail, or each cluster by what culling made of it. An
// indirect command and a record with its tint for every run of one colour. Owner thread: render.
#pragma once

#include <vector>

#include "gpu/memory.h"
#include "render/chunk_pools.h"
#include "render/cull_lists.h"
#include "render/renderer.h"
#include "shared/types.h"

namespace eye {

// Colours as displayed. `why`: EYE_FATE_VISIBLE and so on.
glm::vec3 tintOfLevel(int level);
glm::vec3 tintOfFate(uint32_t why);

// The clusters of each chunk and their fates, as the last late pass left them.
class FateMemory {
 public:
  // Of the frame that has finished, which had a depth map. Slow: the clusters are copied from the GPU.
  void remember(const GpuDevice& gpu, const ChunkPools& pools, const CullLists& lists);
  void forget();

  struct Cluster {
    uint32_t firstIndex, indexCount, why;  // EYE_FATE_VISIBLE and so on
  };
  // In order and without a gap; empty where the chunk was not there, or another was in its place.
  std::span<const Cluster> clustersOf(const GpuChunk& chunk) const;

 private:
  struct Run {
    uint32_t clusterOffset, begin, count;  // of the pool; of clusters_
  };
  std::vector<Run> runs_;  // by clusterOffset
  std::vector<Cluster> clusters_;
};

class TintLists {
 public:
  // Nothing may be in flight. Surfaces first, then skirts.
  void write(const GpuDevice& gpu, std::span<const ChunkDraw> draws, const Vec3d& eyeEcefM, int textureSize, Tint tint,
             const FateMemory& fates);
  const GpuBuffer& draws() const { return draws_; }
  const GpuBuffer& commands() const { return commands_; }
  uint32_t count() const { return static_cast<uint32_t>(commandList_.size()); }

 private:
  void add(shader::DrawData record, const glm::vec4& tint, const GpuChunk& chunk, uint32_t firstIndex,
           uint32_t indexCount);

  std::vector<shader::DrawData> recordList_;
  std::vector<vk::DrawIndexedIndirectCommand> commandList_;
  size_t capacity_ = 0;
  GpuBuffer draws_, commands_;
};

}  // namespace eye
