#include "render/band.h"

#include <algorithm>
#include <cmath>

#include "gpu/pipeline_cache.h"
#include "render/cull_pass.h"

namespace eye {
namespace {

// The view of those columns alone.
View columnsOf(View view, const vk::Rect2D& area) {
  const Frustum whole = view.frustum;
  const auto tanAt = [&](double px) { return std::lerp(whole.tanLeft, whole.tanRight, px / view.widthPx); };
  view.frustum.tanLeft = tanAt(area.offset.x);
  view.frustum.tanRight = tanAt(area.offset.x + static_cast<int>(area.extent.width));
  view.widthPx = static_cast<int>(area.extent.width);
  return view;
}

// What each band does by itself, as timestamps name it.
constexpr std::array<std::string_view, 5> kDrawing{"scene", "early", "depth_map", "sky", "late"};

}  // namespace

Band::Band(const GpuDevice& device, const SceneOptions& options, bool isAll)
    : gpu(device),
      cachePath(pipelineCachePath(device)),
      cache(loadPipelineCache(device, cachePath)),
      scene(device, cache, options),
      timestamps(device),
      frame(device),
      sky(device) {
  if (options.samples != vk::SampleCountFlagBits::e1) farthest = std::make_unique<FarthestSample>(device, cache);
  if (isAll) overlap = std::make_unique<RasterOverlap>(device);
}

void Band::place(const FrameInput& input, const shader::FrameData& data, const vk::Rect2D& area, bool airByPixel) {
  targets.area = area;
  scene.frame() = data;
  scene.placeSky(input, columnsOf(input.view, area), airByPixel);
  scene.placeClouds(input);
  scene.faceAs(input.view.frustum);
}

void Band::begin() {
  skyIsDrawn = false;
  frame.begin();
  timestamps.begin(frame.commands());
  if (overlap) overlap->begin(frame.commands());
}

void Band::wait() {
  frame.wait(gpu);
  if (skyIsDrawn) sky.wait(gpu);
}

// Commands `first` to `first + count - 1`, with the device told to go ahead before those of `handOvers`, see
// RasterOverlap.
void Band::drawTerrain(HazeBy haze, const IndirectDraws& indirect, uint32_t first, uint32_t count,
                       std::span<const uint32_t> handOvers) {
  const vk::raii::CommandBuffer& commands = frame.commands();
  const auto drawUpTo = [&](uint32_t end) {
    scene.drawTerrain(haze, commands, gpu, indirect, first, end - first);
    first = end;
  };
  const uint32_t end = first + count;
  for (const uint32_t next : handOvers) {
    if (next < first || next >= end) continue;  // of another range
    drawUpTo(next);
    overlap->handOver(commands);
  }
  drawUpTo(end);
}

// Where no terrain is, and before it.
void Band::drawAir(const FrameInput& input) {
  if (input.background) return;
  if (!skyIsDrawn) scene.drawSky(frame.commands());
  scene.drawClouds(frame.commands());
}

void Band::drawScene(const FrameInput& input, const IndirectDraws& indirect, const DrawCounts& counts,
                     std::span<const uint32_t> handOvers) {
  const vk::raii::CommandBuffer& commands = frame.commands();
  scene.begin(commands, targets, ScenePass::Pass::whole);
  drawTerrain(HazeBy::vertex, indirect, counts.byVertex.first, counts.byVertex.count(), handOvers);
  drawTerrain(HazeBy::pixel, indirect, counts.byPixel.first, counts.byPixel.count(), handOvers);
  drawAir(input);
  scene.end(commands);
  timestamps.mark(commands, "scene");
}

void Band::drawEarly(const IndirectDraws& clusters, uint32_t byVertex, uint32_t count,
                     std::span<const uint32_t> handOvers) {
  const vk::raii::CommandBuffer& commands = frame.commands();
  scene.begin(commands, targets, ScenePass::Pass::first);
  drawTerrain(HazeBy::vertex, clusters, 0, byVertex, handOvers);
  drawTerrain(HazeBy::pixel, clusters, byVertex, count - byVertex, handOvers);
  scene.end(commands);
  timestamps.mark(commands, "early");
}

void Band::copyDepth(const GpuBuffer& to) {
  if (farthest) {
    farthest->record(frame.commands(), targets);
  } else {
    recordDepthCopy(frame.commands(), targets, to);
  }
}

void Band::submitSky() {
  const vk::raii::CommandBuffer& commands = sky.commands();
  sky.begin();
  scene.begin(commands, targets, ScenePass::Pass::between);
  scene.drawSky(commands);
  scene.end(commands);
  timestamps.mark(commands, "sky");
  sky.submit(gpu);
  skyIsDrawn = true;
}

// The skirts, few and mostly hidden, are not tested.
void Band::drawLate(const FrameInput& input, const IndirectDraws& clusters, uint32_t byVertex, uint32_t count,
                    const IndirectDraws& skirts, const DrawCounts& counts) {
  const vk::raii::CommandBuffer& commands = frame.commands();
  scene.begin(commands, targets, ScenePass::Pass::goesOn);
  if (!input.freezeCulling) {
    drawTerrain(HazeBy::vertex, clusters, 0, byVertex);
    drawTerrain(HazeBy::pixel, clusters, byVertex, count - byVertex);
  }
  drawTerrain(HazeBy::vertex, skirts, counts.byVertex.firstSkirt(), counts.byVertex.skirts);
  drawTerrain(HazeBy::pixel, skirts, counts.byPixel.firstSkirt(), counts.byPixel.skirts);
  drawAir(input);
  scene.end(commands);
  timestamps.mark(commands, "late");
}

void Band::drawDepthAtCentres(const IndirectDraws& indirect, uint32_t count) {
  scene.drawDepthAtCentres(frame.commands(), gpu, targets, indirect, count);
  timestamps.mark(frame.commands(), "depth");
}

const std::vector<Timestamps::Span>& Band::readTimes() {
  const std::vector<Timestamps::Span>& spans = timestamps.read();
  busyMs_ = 0;
  for (const Timestamps::Span& span : spans)
    if (std::ranges::find(kDrawing, span.name) != kDrawing.end()) busyMs_ += span.endMs - span.beginMs;
  return spans;
}

}  // namespace eye
