// The compute passes of two-pass occlusion culling: which clusters to draw early, the depth pyramid of what was drawn,
// which of the others to draw late. Records commands; the renderer draws in between.
#pragma once

#include "render/chunk_pools.h"
#include "render/cull_lists.h"
#include "render/targets.h"

namespace eye {

// Copies the depth target's area, the target being left as one, for the pyramid. `to`: of the whole picture.
void recordDepthCopy(const vk::raii::CommandBuffer& commands, const Targets& targets, const GpuBuffer& to);

class CullPass {
 public:
  // Throws vk::SystemError. `cache` gets what the driver compiles.
  CullPass(const GpuDevice& gpu, const vk::raii::PipelineCache& cache);

  // Nothing that uses the set may be in flight.
  void bind(const GpuDevice& gpu, const ChunkPools& pools, const CullLists& lists);

  // Runs each variant of a pipeline once, with results that nobody wants: the driver compiles at the first use.
  void recordWarmUp(const vk::raii::CommandBuffer& commands) const;
  // Writes the early commands from last frame's visibility. Outside a render pass.
  void recordEarly(const vk::raii::CommandBuffer& commands, const CullLists& lists) const;
  // Reduces the copied depth. Not where the CPU does it.
  void recordDepthPyramid(const vk::raii::CommandBuffer& commands, const CullLists& lists) const;
  // Writes the late commands, the fates (for the CPU) and the visibility for the next frame.
  void recordLate(const vk::raii::CommandBuffer& commands, const CullLists& lists) const;

 private:
  void dispatchClusters(const vk::raii::CommandBuffer& commands, const vk::raii::Pipeline& pipeline,
                        const CullLists& lists) const;
  void recordLevel(const vk::raii::CommandBuffer& commands, const shader::DepthLevel& level) const;

  vk::raii::DescriptorSetLayout setLayout_{nullptr};
  vk::raii::DescriptorPool pool_{nullptr};
  vk::raii::DescriptorSet set_{nullptr};
  vk::raii::PipelineLayout layout_{nullptr};
  vk::raii::Pipeline early_{nullptr}, late_{nullptr}, reduce_{nullptr};
  std::vector<vk::raii::Pipeline> map_;  // for texels of any number of pixels each way, of one, of two ...
};

}  // namespace eye
