// A frame with occlusion culling: what was visible is drawn, its depth tells what else shows, and that is drawn too.
#include "render/renderer_impl.h"
#include "telemetry/trace.h"

namespace eye {
namespace {

double millisecondsSince(int64_t beganNs) {
  return static_cast<double>(monotonicNs() - beganNs) * 1e-6;
}

}  // namespace

void Renderer::Impl::cullEarly() {
  if (!cullLists->onHost()) {
    cull->recordEarly(frame.commands(), *cullLists);
    return;
  }
  const TraceScope scope("cull early");
  const int64_t beganNs = monotonicNs();
  cullLists->cullEarly(*pools);
  hostEarlyMs = millisecondsSince(beganNs);
}

// Where nothing is yet: what the late pass adds is drawn over it.
void Renderer::Impl::submitSky() {
  const vk::raii::CommandBuffer& commands = sky.commands();
  sky.begin();
  scene->begin(commands, targets, ScenePass::Pass::between);
  scene->drawSky(commands);
  scene->end(commands);
  timestamps->mark(commands, "sky");
  sky.submit(*gpu);
  skyIsDrawn = true;
}

// By the CPU: when the commands so far have been executed, on a device that is a CPU at no more than a barrier's cost.
// Other threads of the device draw the sky meanwhile.
void Renderer::Impl::cullLate(const FrameInput& input) {
  if (!cullLists->onHost()) {
    cull->recordDepthPyramid(frame.commands(), *cullLists);
    timestamps->mark(frame.commands(), "depth_map");
    cull->recordLate(frame.commands(), *cullLists);
    return;
  }
  timestamps->mark(frame.commands(), "depth_map");
  frame.submit(*gpu);
  if (!input.background) submitSky();
  frame.wait(*gpu);
  const TraceScope scope("cull late");
  const int64_t beganNs = monotonicNs();
  cullLists->cullLate(*pools);
  hostLateMs = millisecondsSince(beganNs);
  frame.begin();
}

// Two passes: what was visible in the last frame, then what else its depth does not hide. The skirts, few and mostly
// hidden, are not tested.
void Renderer::Impl::recordCulledScene(const FrameInput& input, const DrawCounts& counts) {
  const vk::raii::CommandBuffer& commands = frame.commands();
  const IndirectDraws skirts{lists->commands(), pools->indexBuffer()};
  const auto drawClusters = [&](const GpuBuffer& clusterCommands, std::span<const uint32_t> handOvers) {
    const IndirectDraws indirect{clusterCommands, cullLists->onHost() ? cullLists->packedIndices() : skirts.indices};
    const uint32_t byVertex = cullLists->candidatesByVertex();
    drawInBatches(HazeBy::vertex, indirect, 0, byVertex, handOvers);
    drawInBatches(HazeBy::pixel, indirect, byVertex, cullLists->candidateCount() - byVertex, handOvers);
  };
  cullEarly();
  timestamps->mark(commands, "cull_early");
  scene->begin(commands, targets, ScenePass::Pass::first);
  std::vector<uint32_t> handOvers;
  if (cullLists->onHost())
    handOvers =
        overlap->handOvers(cullLists->earlyBuffer().as<const shader::DrawCommand>().first(cullLists->candidateCount()));
  drawClusters(cullLists->earlyBuffer(), handOvers);
  scene->end(commands);
  timestamps->mark(commands, "early");
  if (!input.freezeCulling) {
    if (farthest) {
      farthest->record(commands, targets);
    } else {
      recordDepthCopy(commands, targets, *cullLists);
    }
    cullLate(input);
    timestamps->mark(commands, "cull_late");
  }
  scene->begin(commands, targets, ScenePass::Pass::goesOn);
  if (!input.freezeCulling) drawClusters(cullLists->lateBuffer(), {});
  drawInBatches(HazeBy::vertex, skirts, counts.byVertex.firstSkirt(), counts.byVertex.skirts, {});
  drawInBatches(HazeBy::pixel, skirts, counts.byPixel.firstSkirt(), counts.byPixel.skirts, {});
  drawAir(input);
  scene->end(commands);
  timestamps->mark(commands, "late");
}

}  // namespace eye
