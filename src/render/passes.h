// The two passes of a frame, with the descriptor set and pipelines that they share:
//   geometry  chunks into depth and a slim attribute target (8 bytes a pixel)
//   shade     once per pixel: imagery, light, haze, sky
#pragma once

#include "render/chunk_pools.h"
#include "render/draw_lists.h"
#include "render/targets.h"

namespace eye {

class Passes {
 public:
  // Throws vk::SystemError. `cache` gets what the driver compiles.
  Passes(const GpuDevice& gpu, const vk::raii::PipelineCache& cache, vk::Format colourFormat);

  void bindTargets(const GpuDevice& gpu, const Targets& targets);
  void bindDraws(const GpuDevice& gpu, const DrawLists& lists);
  void bindTextures(const GpuDevice& gpu, const GpuImage& textures);
  shader::FrameData& frame() { return frame_.as<shader::FrameData>()[0]; }

  // Depth and attributes, ready to be sampled afterwards.
  void recordGeometry(const vk::raii::CommandBuffer& commands, const GpuDevice& gpu, const Targets& targets,
                      const ChunkPools& pools, const DrawLists& lists, uint32_t commandCount) const;
  // Leaves the colour in usageColourTarget.
  void recordShade(const vk::raii::CommandBuffer& commands, const Targets& targets) const;

 private:
  GpuBuffer frame_;
  vk::raii::Sampler imagerySampler_{nullptr}, fetchSampler_{nullptr};
  vk::raii::DescriptorSetLayout setLayout_{nullptr};
  vk::raii::DescriptorPool pool_{nullptr};
  vk::raii::DescriptorSet set_{nullptr};
  vk::raii::PipelineLayout layout_{nullptr};
  vk::raii::Pipeline geometry_{nullptr}, shade_{nullptr};
};

}  // namespace eye
