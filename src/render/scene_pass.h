// The scene: terrain, then the sky where no terrain is, with the descriptors and pipelines of both.
#pragma once

#include "geo/scene_bend.h"
#include "render/chunk_pools.h"
#include "render/cloud_faces.h"
#include "render/draw_lists.h"
#include "render/haze_width.h"
#include "render/picture_quality.h"
#include "render/sky_dome.h"
#include "render/star_field.h"
#include "render/targets.h"

namespace eye {

struct SceneOptions {
  vk::Format colourFormat = vk::Format::eUndefined;
  vk::SampleCountFlagBits samples = vk::SampleCountFlagBits::e1;
  TextureFilter filter = TextureFilter::device;
  bool withTints = false;         // drawTinted may be called
  std::optional<SceneBend> bend;  // of the terrain, tinted excepted
};

// What `device` means there.
TextureFilter filterOn(const GpuDevice& gpu, TextureFilter filter);

// Indirect commands and what they count in, on one device.
struct IndirectDraws {
  vk::Buffer commands, indices, vertices;
  vk::Buffer records;  // DrawData; a command's firstInstance is its number
};

class ScenePass {
 public:
  // Throws vk::SystemError. `cache` gets what the driver compiles.
  ScenePass(const GpuDevice& gpu, const vk::raii::PipelineCache& cache, const SceneOptions& options);

  void bindTextures(const GpuDevice& gpu, const GpuImage& textures);
  // What drawSky draws: the sky by dome, its part in `columns`, or by pixel, and which stars; and what is under all
  // that is drawn. `columns`: the view, or as much of it as is drawn.
  void placeSky(const FrameInput& input, const View& columns, bool byPixel);
  // In a mirrored view what is counterclockwise as seen from outside is clockwise on the screen; mirrored both ways it
  // is not.
  void faceAs(const Frustum& frustum) {
    flips_ = (frustum.tanLeft > frustum.tanRight) != (frustum.tanBottom > frustum.tanTop);
  }
  // What drawClouds draws; after frame() has been set.
  void placeClouds(const FrameInput& input) { clouds_ = cloudFaces(input, frame()); }
  shader::FrameData& frame() { return frame_.as<shader::FrameData>()[0]; }

  // One render pass, the whole, or a first and one that goes on with what that has drawn, or draw it over: begin, draw,
  // end. `between`: goes on, and is not the last. Colour and depth are left as targets, but before the last of several
  // passes the colour of a picture with several samples a pixel is still in its samples. Nothing outside of
  // targets.area is touched.
  enum class Pass { whole, first, between, goesOn, over };
  void begin(const vk::raii::CommandBuffer& commands, const Targets& targets, Pass pass) const;
  // Indirect commands `first` to `first + count - 1`.
  void drawTerrain(HazeBy haze, const vk::raii::CommandBuffer& commands, const GpuDevice& gpu,
                   const IndirectDraws& indirect, uint32_t first, uint32_t count) const;
  // The depth at the pixels' centres into targets.depth, of pictures with several samples a pixel: all by itself.
  void drawDepthAtCentres(const vk::raii::CommandBuffer& commands, const GpuDevice& gpu, const Targets& targets,
                          const IndirectDraws& indirect, uint32_t count) const;
  // As drawTerrain, both faces, in the tints that the draws' records bring, see TintLists.
  void drawTinted(const vk::raii::CommandBuffer& commands, const GpuDevice& gpu, const IndirectDraws& indirect,
                  uint32_t count) const;
  // With the stars, if any show.
  void drawSky(const vk::raii::CommandBuffer& commands) const;
  // The layers of cloud before what is there, those behind first. Writes no depth.
  void drawClouds(const vk::raii::CommandBuffer& commands) const;
  void end(const vk::raii::CommandBuffer& commands) const { commands.endRendering(); }

 private:
  void beginWith(const vk::raii::CommandBuffer& commands, const Targets& targets, vk::RenderingInfo info) const;
  void drawWith(const vk::raii::Pipeline& pipeline, const vk::raii::CommandBuffer& commands, const GpuDevice& gpu,
                const IndirectDraws& indirect, uint32_t first, uint32_t count) const;

  bool flips_ = false;
  GpuBuffer frame_, starBuffer_;
  std::vector<StarInstance> placedStars_;
  std::optional<DomePart> dome_;    // nothing: by pixel
  std::optional<glm::vec3> under_;  // nothing: every pixel is drawn
  std::vector<shader::CloudFace> clouds_;
  vk::raii::Sampler sampler_{nullptr};
  vk::raii::DescriptorSetLayout setLayout_{nullptr};
  vk::raii::DescriptorPool pool_{nullptr};
  vk::raii::DescriptorSet set_{nullptr};
  vk::raii::PipelineLayout layout_{nullptr}, cloudLayout_{nullptr};
  vk::raii::Pipeline terrain_{nullptr}, wide_{nullptr}, tinted_{nullptr}, sky_{nullptr}, domeSky_{nullptr},
      sun_{nullptr}, star_{nullptr}, cloud_{nullptr}, depthAtCentres_{nullptr};
};

}  // namespace eye
