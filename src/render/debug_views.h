// What FrameInput asks to see of culling itself, drawn over the finished scene. Owner thread: render.
#pragma once

#include "gpu/timestamps.h"
#include "render/depth_view.h"
#include "render/scene_pass.h"
#include "render/tint_lists.h"

namespace eye {

class DebugViews {
 public:
  // Throws vk::SystemError. `cache` gets what the driver compiles.
  DebugViews(const GpuDevice& gpu, const vk::raii::PipelineCache& cache, vk::Format colourFormat);

  void bind(const GpuDevice& gpu, const CullLists& lists) { depthView_.bind(gpu, lists); }
  // Before the frame's culling lists are written: they still hold what the last frame left.
  void prepare(const GpuDevice& gpu, const FrameInput& input, const ChunkPools& pools, const CullLists& lists,
               int textureSize);
  // Colour and depth are targets before and after; so is all that the scene's passes need.
  void record(const vk::raii::CommandBuffer& commands, const GpuDevice& gpu, const FrameInput& input,
              const ScenePass& scene, const ChunkPools& pools, const Targets& targets, const CullLists& lists,
              Timestamps& timestamps) const;

 private:
  DepthView depthView_;
  TintLists tints_;
  FateMemory fates_;
  bool lastFrozen_ = false, lastCulled_ = false;  // the last frame
};

}  // namespace eye
