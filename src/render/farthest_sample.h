// The depth of a picture with several samples a pixel as the depth pyramid wants it: the farthest sample of each pixel.
// Records commands.
#pragma once

#include "render/cull_lists.h"
#include "render/targets.h"

namespace eye {

class FarthestSample {
 public:
  // Throws vk::SystemError. `cache` gets what the driver compiles.
  FarthestSample(const GpuDevice& gpu, const vk::raii::PipelineCache& cache);
  // Nothing that uses the set may be in flight.
  void bind(const GpuDevice& gpu, const Targets& targets, const GpuBuffer& to);
  // As recordDepthCopy, from targets.depthSamples, which are left as a target. The area begins with a group of
  // EYE_DEPTH_GROUP pixels.
  void record(const vk::raii::CommandBuffer& commands, const Targets& targets) const;

 private:
  vk::raii::Sampler sampler_{nullptr};
  vk::raii::DescriptorSetLayout setLayout_{nullptr};
  vk::raii::DescriptorPool pool_{nullptr};
  vk::raii::DescriptorSet set_{nullptr};
  vk::raii::PipelineLayout layout_{nullptr};
  vk::raii::Pipeline pipeline_{nullptr};
};

}  // namespace eye
