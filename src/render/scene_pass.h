// The scene: terrain, then the sky where no terrain is, with the descriptors and pipelines of both.
#pragma once

#include "geo/scene_bend.h"
#include "render/chunk_pools.h"
#include "render/draw_lists.h"
#include "render/star_field.h"
#include "render/targets.h"

namespace eye {

class ScenePass {
 public:
  // Throws vk::SystemError. `cache` gets what the driver compiles.
  // `withTints`: drawTinted may be called.
  // `bend`: of the terrain, tinted excepted.
  ScenePass(const GpuDevice& gpu, const vk::raii::PipelineCache& cache, vk::Format colourFormat, bool withTints,
            const std::optional<SceneBend>& bend);

  void bindTextures(const GpuDevice& gpu, const GpuImage& textures);
  void placeStars(const FrameInput& input);  // those that drawSky draws
  // In a mirrored view what is counterclockwise as seen from outside is clockwise on the screen; mirrored both ways it
  // is not.
  void faceAs(const Frustum& frustum) {
    flips_ = (frustum.tanLeft > frustum.tanRight) != (frustum.tanBottom > frustum.tanTop);
  }
  shader::FrameData& frame() { return frame_.as<shader::FrameData>()[0]; }

  // One render pass, or more that go on with what the first has drawn, or draw it over: begin, draw, end.
  // `background`: a flat colour instead of the sky. Colour and depth are left as targets.
  enum class Pass { first, goesOn, over };
  void begin(const vk::raii::CommandBuffer& commands, const Targets& targets, Pass pass,
             const std::optional<glm::vec3>& background) const;
  // Indirect commands `first` to `first + count - 1`; their firstInstance is the DrawData's index.
  void drawTerrain(const vk::raii::CommandBuffer& commands, const GpuDevice& gpu, const ChunkPools& pools,
                   const GpuBuffer& draws, const GpuBuffer& indirect, uint32_t first, uint32_t count) const;
  // As drawTerrain, both faces, in the tints that the draws' records bring, see TintLists.
  void drawTinted(const vk::raii::CommandBuffer& commands, const GpuDevice& gpu, const ChunkPools& pools,
                  const GpuBuffer& draws, const GpuBuffer& indirect, uint32_t count) const;
  // With the stars, if any show.
  void drawSky(const vk::raii::CommandBuffer& commands) const;
  void end(const vk::raii::CommandBuffer& commands) const { commands.endRendering(); }

 private:
  void drawWith(const vk::raii::Pipeline& pipeline, const vk::raii::CommandBuffer& commands, const GpuDevice& gpu,
                const ChunkPools& pools, const GpuBuffer& draws, const GpuBuffer& indirect, uint32_t first,
                uint32_t count) const;

  bool flips_ = false;
  GpuBuffer frame_, starBuffer_;
  std::vector<StarInstance> placedStars_;
  vk::raii::Sampler sampler_{nullptr};
  vk::raii::DescriptorSetLayout setLayout_{nullptr};
  vk::raii::DescriptorPool pool_{nullptr};
  vk::raii::DescriptorSet set_{nullptr};
  vk::raii::PipelineLayout layout_{nullptr};
  vk::raii::Pipeline terrain_{nullptr}, tinted_{nullptr}, sky_{nullptr}, star_{nullptr};
};

}  // namespace eye
