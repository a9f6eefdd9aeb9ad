// The scene: terrain, then the sky where no terrain is, in one render pass; with the descriptors and pipelines of both.
#pragma once

#include "render/chunk_pools.h"
#include "render/draw_lists.h"
#include "render/targets.h"

namespace eye {

class ScenePass {
 public:
  // Throws vk::SystemError. `cache` gets what the driver compiles.
  ScenePass(const GpuDevice& gpu, const vk::raii::PipelineCache& cache, vk::Format colourFormat);

  void bindTextures(const GpuDevice& gpu, const GpuImage& textures);
  shader::FrameData& frame() { return frame_.as<shader::FrameData>()[0]; }

  // Leaves colour and depth as targets. `background`: a flat colour instead of the sky.
  void record(const vk::raii::CommandBuffer& commands, const GpuDevice& gpu, const Targets& targets,
              const ChunkPools& pools, const DrawLists& lists, uint32_t commandCount,
              const std::optional<glm::vec3>& background) const;

 private:
  GpuBuffer frame_;
  vk::raii::Sampler sampler_{nullptr};
  vk::raii::DescriptorSetLayout setLayout_{nullptr};
  vk::raii::DescriptorPool pool_{nullptr};
  vk::raii::DescriptorSet set_{nullptr};
  vk::raii::PipelineLayout layout_{nullptr};
  vk::raii::Pipeline terrain_{nullptr}, sky_{nullptr};
};

}  // namespace eye
