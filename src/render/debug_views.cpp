#include "render/debug_views.h"

namespace eye {

DebugViews::DebugViews(const GpuDevice& gpu, const vk::raii::PipelineCache& cache, vk::Format colourFormat)
    : depthView_(gpu, cache, colourFormat) {}

void DebugViews::prepare(const GpuDevice& gpu, const FrameInput& input, const ChunkPools& pools, const CullLists& lists,
                         int textureSize) {
  // A frozen frame draws with what was known when it froze, and so does its view of fates.
  if ((input.tint == Tint::fate || input.freezeCulling) && !lastFrozen_)
    lastCulled_ ? fates_.remember(gpu, pools, lists) : fates_.forget();
  if (input.tint != Tint::none) tints_.write(gpu, input.draws, input.view.eyeEcefM, textureSize, input.tint, fates_);
  lastFrozen_ = input.freezeCulling;
  lastCulled_ = input.depthMapPx.has_value();
}

void DebugViews::record(const vk::raii::CommandBuffer& commands, const GpuDevice& gpu, const FrameInput& input,
                        const ScenePass& scene, const ChunkPools& pools, const Targets& targets, const CullLists& lists,
                        Timestamps& timestamps) const {
  if (input.tint != Tint::none) {
    scene.begin(commands, targets, ScenePass::Pass::over);
    const IndirectDraws tinted{.commands = *tints_.commands().buffer,
                               .indices = *pools.indexBuffer().buffer,
                               .vertices = *pools.vertexBuffer().buffer,
                               .records = *tints_.draws().buffer};
    scene.drawTinted(commands, gpu, tinted, tints_.count());
    if (!input.background) scene.drawSky(commands);
    scene.end(commands);
    timestamps.mark(commands, "tint");
  }
  if (input.showDepthMap && input.depthMapPx && lists.candidateCount() > 0) {
    depthView_.record(commands, targets, lists);
    timestamps.mark(commands, "depth_view");
  }
}

}  // namespace eye
