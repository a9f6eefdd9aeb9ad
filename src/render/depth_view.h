// The depth map and its pyramid over the picture, level beside level in the lower left: for looking at. Owner thread:
// render.
#pragma once

#include "render/cull_lists.h"
#include "render/targets.h"

namespace eye {

class DepthView {
 public:
  // Throws vk::SystemError. `cache` gets what the driver compiles.
  DepthView(const GpuDevice& gpu, const vk::raii::PipelineCache& cache, vk::Format colourFormat);

  // Nothing that uses the set may be in flight.
  void bind(const GpuDevice& gpu, const CullLists& lists);
  // Draws the pyramid of the last frame that made one over the colour target, which is in usageColourTarget before and
  // after.
  void record(const vk::raii::CommandBuffer& commands, const Targets& targets, const CullLists& lists) const;

 private:
  vk::raii::DescriptorSetLayout setLayout_{nullptr};
  vk::raii::DescriptorPool pool_{nullptr};
  vk::raii::DescriptorSet set_{nullptr};
  vk::raii::PipelineLayout layout_{nullptr};
  vk::raii::Pipeline pipeline_{nullptr};
};

}  // namespace eye
