// A frame with occlusion culling: what was visible is drawn, its depth tells what else shows, and that is drawn too.
#include "render/renderer_impl.h"
#include "telemetry/trace.h"

namespace eye {
namespace {

double millisecondsSince(int64_t beganNs) {
  return static_cast<double>(monotonicNs() - beganNs) * 1e-6;
}

}  // namespace

IndirectDraws Renderer::Impl::clustersOf(size_t band, const GpuBuffer& commands) const {
  IndirectDraws clusters = drawsOf(band);
  clusters.commands = *commands.buffer;
  if (cullLists->onHost()) clusters.indices = *cullLists->packedIndices(band).buffer;
  return clusters;
}

void Renderer::Impl::cullEarly(const BandTest& bandTest) {
  if (!cullLists->onHost()) {
    cull->recordEarly(first().frame.commands(), *cullLists);
    return;
  }
  const TraceScope scope("cull early");
  const int64_t beganNs = monotonicNs();
  cullLists->cullEarly(*pools, bandTest);
  hostEarlyMs = millisecondsSince(beganNs);
}

// By the CPU: when the commands so far have been executed, on a device that is a CPU at no more than a barrier's cost.
// Other threads of the devices draw the sky meanwhile.
void Renderer::Impl::cullLate(const FrameInput& input, const BandTest& bandTest, size_t used) {
  if (!cullLists->onHost()) {
    const vk::raii::CommandBuffer& commands = first().frame.commands();
    cull->recordDepthPyramid(commands, *cullLists);
    first().timestamps.mark(commands, "depth_map");
    cull->recordLate(commands, *cullLists);
    return;
  }
  for (size_t i = 0; i < used; ++i) {
    Band& band = *bands[i];
    band.timestamps.mark(band.frame.commands(), "depth_map");
    band.frame.submit(band.gpu);
    if (!input.background) band.submitSky();
  }
  for (size_t i = 0; i < used; ++i) bands[i]->frame.wait(bands[i]->gpu);
  {
    const TraceScope scope("cull late");
    const int64_t beganNs = monotonicNs();
    cullLists->cullLate(*pools, bandTest, first().farthest == nullptr);
    hostLateMs = millisecondsSince(beganNs);
  }
  for (size_t i = 0; i < used; ++i) bands[i]->frame.begin();
}

// Two passes: what was visible in the last frame, then what else its depth does not hide.
void Renderer::Impl::drawCulledScene(const FrameInput& input, const DrawCounts& counts, const BandTest& bandTest,
                                     size_t used) {
  const uint32_t byVertex = cullLists->candidatesByVertex(), count = cullLists->candidateCount();
  cullEarly(bandTest);
  std::vector<uint32_t> handOvers;
  if (first().overlap && cullLists->onHost())
    handOvers = first().overlap->handOvers(cullLists->earlyBuffer().as<const shader::DrawCommand>().first(count));
  for (size_t i = 0; i < used; ++i) {
    Band& band = *bands[i];
    band.timestamps.mark(band.frame.commands(), "cull_early");
    band.drawEarly(clustersOf(i, cullLists->earlyBuffer(i)), byVertex, count, handOvers);
    if (!input.freezeCulling) band.copyDepth(cullLists->depthBuffer(i));
  }
  if (!input.freezeCulling) cullLate(input, bandTest, used);
  for (size_t i = 0; i < used; ++i) {
    Band& band = *bands[i];
    if (!input.freezeCulling) band.timestamps.mark(band.frame.commands(), "cull_late");
    band.drawLate(input, clustersOf(i, cullLists->lateBuffer(i)), byVertex, count, drawsOf(i), counts);
  }
}

}  // namespace eye
