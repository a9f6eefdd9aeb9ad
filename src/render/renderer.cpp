#include "render/renderer.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "gpu/pipeline_cache.h"
#include "gpu/time_slices.h"
#include "render/frame_data.h"
#include "render/haze_width.h"
#include "render/renderer_impl.h"
#include "render/warm_up.h"
#include "telemetry/cpu_time.h"
#include "telemetry/trace.h"

namespace eye {

namespace {

// Pixels of the picture under a texel of the depth map, each way: lavapipe ends a shader's loops after 65,535 rounds.
constexpr int kMostPixelsPerTexel = 128;

glm::ivec2 usableMap(glm::ivec2 mapPx, glm::ivec2 picturePx) {
  return glm::max(mapPx, (picturePx + (kMostPixelsPerTexel - 1)) / kMostPixelsPerTexel);
}

vk::SampleCountFlagBits sampleCount(const RendererOptions& options) {
  return options.samples > 1 ? vk::SampleCountFlagBits::e4 : vk::SampleCountFlagBits::e1;
}

bool drawsSamples(const GpuDevice& gpu, vk::SampleCountFlagBits samples) {
  return static_cast<bool>(gpu.traits.sampleCounts & samples);
}

// A device that is a CPU has a thread for each core that rasterises and one more that bins: whichever waits for a core
// that another keeps for some milliseconds holds up all of them. The shortest that Linux takes.
constexpr std::chrono::microseconds kSlice{100};

std::vector<uint16_t> copyOf(std::span<const uint16_t> values) {
  return {values.begin(), values.end()};
}

bool cullsOnHost(const RendererOptions& options, const GpuDevice& gpu) {
  return options.cullBy == CullBy::host || (options.cullBy == CullBy::device && gpu.traits.cullsOnHost);
}

}  // namespace

Renderer::Renderer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

Renderer::~Renderer() {
  (void)vkDeviceWaitIdle(*impl_->gpu->device);  // shutdown; vk::raii would throw where the device is lost
}

Result<std::vector<DeviceDescription>> Renderer::listDevices() {
  return eye::listDevices();
}

Result<std::unique_ptr<Renderer>> Renderer::create(const RendererOptions& options) {
  try {
    auto impl = std::make_unique<Impl>();
    impl->options = options;
    if (options.window) {
      auto window = Window::open({options.widthPx, options.heightPx, options.fullscreen, options.monitor});
      if (!window) return tl::unexpected(window.error());
      impl->window = std::move(*window);
    }
    askForSlices(kSlice);  // before the device's threads are made
    auto gpu = createDevice({options.device, options.validate, options.window});
    if (!gpu) return tl::unexpected(gpu.error());
    impl->gpu = std::move(*gpu);
    const GpuDevice& device = *impl->gpu;
    if (!device.traits.isCpu) askForSlices({});
    if (!drawsSamples(device, sampleCount(options)))
      return fail(ErrorKind::unsupported, fmt::format("{} draws no pictures with {} samples a pixel: give --samples 1",
                                                      device.description.name, options.samples));
    if (options.filter == TextureFilter::anisotropic && device.traits.mostAnisotropy <= 1)
      return fail(ErrorKind::unsupported,
                  fmt::format("{} has no anisotropic filter: give --sampler trilinear", device.description.name));
    auto pools = ChunkPools::create(device, options.gpuBudgetBytes, options.textureSize, cullsOnHost(options, device));
    if (!pools) return tl::unexpected(pools.error());
    impl->pools = std::move(*pools);

    if (options.window) impl->swapchain = std::make_unique<Swapchain>(device, *impl->window, options.vsync);

    const std::string cachePath = pipelineCachePath(device);
    impl->cache = loadPipelineCache(device, cachePath);
    GLFWwindow* window = options.window ? impl->window->handle() : nullptr;
    impl->scene = std::make_unique<ScenePass>(device, impl->cache,
                                              SceneOptions{.colourFormat = impl->colourFormat(),
                                                           .samples = sampleCount(options),
                                                           .filter = options.filter,
                                                           .withTints = options.debugViews,
                                                           .bend = options.bend});
    if (options.samples > 1) impl->farthest = std::make_unique<FarthestSample>(device, impl->cache);
    impl->lists = std::make_unique<DrawLists>(device);
    impl->cullLists = std::make_unique<CullLists>(device, cullsOnHost(options, device));
    if (!impl->cullLists->onHost()) {
      impl->cull = std::make_unique<CullPass>(device, impl->cache);
      impl->cull->bind(device, *impl->pools, *impl->cullLists);
      runOnce(device, [&](const vk::raii::CommandBuffer& commands) { impl->cull->recordWarmUp(commands); });
    }
    if (options.debugViews) {
      impl->debug = std::make_unique<DebugViews>(device, impl->cache, impl->colourFormat());
      impl->debug->bind(device, *impl->cullLists);
    }
    impl->overlay = std::make_unique<Overlay>(device, impl->cache, impl->colourFormat(), window);
    impl->timestamps = std::make_unique<Timestamps>(device);
    impl->overlap = std::make_unique<RasterOverlap>(device);
    impl->scene->bindTextures(device, impl->pools->textures());
    impl->frame = Submission(device);
    impl->sky = Submission(device);

    std::unique_ptr<Renderer> renderer(new Renderer(std::move(impl)));
    if (auto warm = warmUp(*renderer, options); !warm) return tl::unexpected(warm.error());
    savePipelineCache(renderer->impl_->cache, cachePath);
    return renderer;
  } catch (const std::exception& e) {
    return fail(ErrorKind::unsupported,
                fmt::format("the graphics device refuses to start ({}): try a smaller --cache-gpu or --size, "
                            "or another --device",
                            e.what()));
  }
}

bool Renderer::hasRoomFor(std::span<const LoadedChunk> chunks) {
  return impl_->pools->hasRoomFor(chunks);
}
bool Renderer::wouldHelp(const GpuChunk& chunk) const {
  return impl_->pools->wouldHelp(chunk);
}
std::optional<GpuChunk> Renderer::upload(const LoadedChunk& chunk) {
  return impl_->pools->upload(chunk);
}
void Renderer::release(const GpuChunk& chunk) {
  impl_->pools->release(chunk);
}
uint64_t Renderer::bytesResident() const {
  return impl_->pools->bytesResident();
}
const DeviceDescription& Renderer::device() const {
  return impl_->gpu->description;
}
TextureFilter Renderer::textureFilter() const {
  return filterOn(*impl_->gpu, impl_->options.filter);
}
uint64_t Renderer::validationMessages() const {
  return impl_->gpu->messages.load();
}

Result<bool> Renderer::awaitDisplay() {
  if (impl_->swapchain == nullptr) return false;
  const TraceScope scope("wait for the display");
  try {
    return impl_->swapchain->acquire(*impl_->gpu);
  } catch (const std::exception& e) {
    return fail(ErrorKind::unsupported,
                fmt::format("the window takes no more pictures ({}): start again, perhaps with --headless", e.what()));
  }
}

Result<FrameOutput> Renderer::drawFrame(const FrameInput& asked) {
  try {
    Impl& impl = *impl_;
    const double cpuBeganMs = processCpuMs();
    FrameInput input = asked;
    impl.resizeTargets(input.view.widthPx, input.view.heightPx);
    impl.lists->reserve(*impl.gpu, input.draws.size());
    impl.scene->frame() = frameData(input);
    impl.scene->placeSky(input, impl.options.airByPixel);
    impl.scene->placeClouds(input);
    impl.scene->faceAs(input.view.frustum);
    const size_t parted = partByHaze(asked.draws, asked.view.eyeEcefM, impl.scene->frame(), impl.draws);
    const size_t byVertex = impl.options.airByPixel ? 0 : parted;
    input.draws = impl.draws;
    const DrawCounts counts = impl.lists->write(input.draws, byVertex, input.view.eyeEcefM, impl.options.textureSize);
    if (impl.debug) impl.debug->prepare(*impl.gpu, input, *impl.pools, *impl.cullLists, impl.options.textureSize);
    const bool culls = impl.prepareCulling(input, byVertex);
    std::optional<uint32_t> shown;
    if (impl.swapchain != nullptr) shown = impl.swapchain->held();
    impl.record(input, counts, culls, shown);
    impl.frame.submit(*impl.gpu);
    impl.frame.wait(*impl.gpu);
    if (impl.skyIsDrawn) impl.sky.wait(*impl.gpu);
    impl.pools->staged();
    impl.drawn = true;

    FrameOutput output;
    if (impl.gpu->traits.isCpu) output.cpuMs = processCpuMs() - cpuBeganMs;
    output.widthPx = impl.targets.widthPx;
    output.heightPx = impl.targets.heightPx;
    output.triangles = counts.surfaceTriangles + counts.skirtTriangles;
    output.vertices = counts.vertices;
    output.draws = counts.draws();
    if (culls) {
      output.clusters = impl.cullLists->counts();
      output.depthMapPx = impl.cullLists->params().mapPx;
      output.triangles = output.clusters.trianglesDrawn + counts.skirtTriangles;
      output.draws = output.clusters.drawn + counts.skirts();
    }
    if (input.readColour) output.rgba = impl.pictureRgba();
    if (input.readDepth) output.depth = impl.targets.depthBack.as<const float>();
    impl.readTimes(output);
    output.completedNs = monotonicNs();
    if (shown) impl.swapchain->present(*impl.gpu);
    return output;
  } catch (const std::exception& e) {
    return fail(ErrorKind::unsupported,
                fmt::format("the graphics device failed while drawing ({}): start again, perhaps with "
                            "another --device",
                            e.what()));
  }
}

void Renderer::Impl::resizeTargets(int widthPx, int heightPx) {
  if (widthPx == targets.widthPx && heightPx == targets.heightPx) return;
  targets = {};  // the old ones first: both at once may not fit
  drawn = false;
  targets = createTargets(*gpu, widthPx, heightPx, colourFormat(), sampleCount(options));
  if (farthest) farthest->bind(*gpu, targets, *cullLists);
  overlay->bindTargets(*gpu, targets);
}

// False: nothing to test, or more than the device's buffers hold: the frame is drawn without the pass.
bool Renderer::Impl::prepareCulling(const FrameInput& input, size_t byVertex) {
  if (!input.depthMapPx) return false;
  const glm::ivec2 picturePx(input.view.widthPx, input.view.heightPx);
  const glm::ivec2 mapPx = usableMap(*input.depthMapPx, picturePx);
  if (!CullLists::fits(*gpu, input.draws, picturePx, mapPx)) return false;
  if (cullLists->reserve(*gpu, input.draws, picturePx, mapPx)) {
    if (cull) cull->bind(*gpu, *pools, *cullLists);
    if (farthest) farthest->bind(*gpu, targets, *cullLists);
    if (debug) debug->bind(*gpu, *cullLists);
  }
  cullLists->write(input.draws, byVertex, input.view, scene->frame().clipFromEcef, mapPx, input.freezeCulling);
  return cullLists->candidateCount() > 0;
}

// Where no terrain is, and before it.
void Renderer::Impl::drawAir(const FrameInput& input) {
  if (input.background) return;
  if (!skyIsDrawn) scene->drawSky(frame.commands());
  scene->drawClouds(frame.commands());
}

// Commands `first` to `first + count - 1`, with the device told to go ahead before those of `handOvers`, see
// RasterOverlap.
void Renderer::Impl::drawInBatches(HazeBy haze, const IndirectDraws& indirect, uint32_t first, uint32_t count,
                                   std::span<const uint32_t> handOvers) {
  const vk::raii::CommandBuffer& commands = frame.commands();
  const auto drawUpTo = [&](uint32_t end) {
    scene->drawTerrain(haze, commands, *gpu, *pools, lists->draws(), indirect, first, end - first);
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

void Renderer::Impl::recordScene(const FrameInput& input, const DrawCounts& counts) {
  const vk::raii::CommandBuffer& commands = frame.commands();
  scene->begin(commands, targets, ScenePass::Pass::whole);
  const IndirectDraws indirect{lists->commands(), pools->indexBuffer()};
  const std::vector<uint32_t> handOvers =
      overlap->handOvers(indirect.commands.as<const shader::DrawCommand>().first(counts.draws()));
  drawInBatches(HazeBy::vertex, indirect, counts.byVertex.first, counts.byVertex.count(), handOvers);
  drawInBatches(HazeBy::pixel, indirect, counts.byPixel.first, counts.byPixel.count(), handOvers);
  drawAir(input);
  scene->end(commands);
  timestamps->mark(commands, "scene");
}

void Renderer::Impl::record(const FrameInput& input, const DrawCounts& counts, bool culls,
                            std::optional<uint32_t> shown) {
  const TraceScope scope("record");
  const vk::raii::CommandBuffer& commands = frame.commands();
  skyIsDrawn = false;
  frame.begin();
  timestamps->begin(commands);
  overlap->begin(commands);
  pools->recordUploads(commands);
  timestamps->mark(commands, "upload");
  if (culls) {
    recordCulledScene(input, counts);
  } else {
    recordScene(input, counts);
  }
  if (debug) debug->record(commands, *gpu, input, *scene, *pools, targets, *cullLists, *timestamps);
  if (input.overlay) {
    overlay->record(commands, targets, input.overlay);
    timestamps->mark(commands, "overlay");
  }
  const std::array toCopy{imageBarrier(targets.colour, usageColourTarget(), usageCopySource())};
  recordBarriers(commands, toCopy);
  if (input.readColour) recordReadBack(commands, targets.colour, targets.colourBack);
  if (input.readDepth) {
    if (targets.isSampled()) scene->drawDepthAtCentres(commands, *gpu, targets, *pools, *lists, counts.draws());
    const std::array depthToCopy{imageBarrier(targets.depth, usageDepthTarget(), usageCopySource())};
    recordBarriers(commands, depthToCopy);
    recordReadBack(commands, targets.depth, targets.depthBack);
  }
  if (input.readColour || input.readDepth) timestamps->mark(commands, "read_back");
  if (shown) {
    swapchain->recordCopy(commands, targets.colour, *shown);
    timestamps->mark(commands, "present");
  }
}

void Renderer::Impl::readTimes(FrameOutput& output) {
  // The GPU's clock is tied to ours by the end of the frame, which the fence has just told.
  const int64_t endNs = monotonicNs();
  const auto& spans = timestamps->read();
  passTimes.clear();
  if (!spans.empty()) output.gpuMs = spans.back().endMs;
  for (const Timestamps::Span& span : spans) {
    const std::string_view name = span.name;
    if (cullLists->onHost() && (name == "cull_early" || name == "cull_late")) {
      passTimes.push_back({span.name, name == "cull_early" ? hostEarlyMs : hostLateMs});
      continue;  // in the trace they are the render thread's
    }
    passTimes.push_back({span.name, span.endMs - span.beginMs});
    const auto at = [&](double ms) { return endNs - static_cast<int64_t>((output.gpuMs - ms) * 1e6); };
    traceSpan("GPU", span.name, at(span.beginMs), at(span.endMs));
  }
  output.passes = passTimes;
}

vk::Format Renderer::Impl::colourFormat() const {
  const bool asWindow = swapchain != nullptr && swapchain->format() == vk::Format::eB8G8R8A8Unorm;
  return asWindow ? vk::Format::eB8G8R8A8Unorm : vk::Format::eR8G8B8A8Unorm;
}

std::span<const uint8_t> Renderer::Impl::pictureRgba() {
  const std::span<const uint8_t> read = targets.colourBack.as<const uint8_t>();
  if (colourFormat() == vk::Format::eR8G8B8A8Unorm) return read;
  rgba.resize(read.size());
  for (size_t i = 0; i < read.size(); i += 4) {
    rgba[i] = read[i + 2];
    rgba[i + 1] = read[i + 1];
    rgba[i + 2] = read[i];
    rgba[i + 3] = read[i + 3];
  }
  return rgba;
}

CullReadBack Renderer::readCulling() const {
  const GpuDevice& gpu = *impl_->gpu;
  const CullLists& lists = *impl_->cullLists;
  const size_t candidates = lists.candidateCount();
  const shader::CullParams params = lists.params();
  const auto pixels = static_cast<size_t>(params.picturePx.x) * static_cast<size_t>(params.picturePx.y);
  return {
      .params = params,
      .chunks = readBuffer<shader::CullChunk>(gpu, lists.chunksBuffer(), lists.chunkCount()),
      .candidates = readBuffer<shader::CullCandidate>(gpu, lists.candidatesBuffer(), candidates),
      .clusters =
          readBuffer<shader::ClusterRecord>(gpu, impl_->pools->clusterBuffer(), impl_->pools->clusterCapacity()),
      .early = readBuffer<shader::DrawCommand>(gpu, lists.earlyBuffer(), candidates),
      .late = readBuffer<shader::DrawCommand>(gpu, lists.lateBuffer(), candidates),
      .fates = readBuffer<uint32_t>(gpu, lists.fatesBuffer(), candidates),
      .depth = readBuffer<float>(gpu, lists.depthBuffer(), pixels),
      .pyramid = readBuffer<float>(gpu, lists.pyramidBuffer(), pyramidLayout(params.mapPx).texels),
      .indices = lists.onHost() ? copyOf(impl_->pools->indexBuffer().as<const uint16_t>()) : std::vector<uint16_t>{},
      .packed = lists.onHost() ? copyOf(lists.packedIndices().as<const uint16_t>()) : std::vector<uint16_t>{}};
}

void Renderer::presentAgain() {
  Impl& impl = *impl_;
  if (impl.swapchain == nullptr || !impl.drawn) return;
  const std::optional<uint32_t> shown = impl.swapchain->held();
  if (!shown) return;
  try {
    impl.frame.begin();
    impl.swapchain->recordCopy(impl.frame.commands(), impl.targets.colour, *shown);
    impl.frame.submit(*impl.gpu);
    impl.frame.wait(*impl.gpu);
    impl.swapchain->present(*impl.gpu);
  } catch (const vk::SystemError& e) {
    spdlog::debug("the last picture cannot be shown again: {}", e.what());  // the next drawFrame reports what is wrong
  }
}

bool Renderer::pollWindow() {
  return impl_->window == nullptr || impl_->window->poll();
}

WindowKeys Renderer::keys() const {
  return impl_->window != nullptr ? impl_->window->keys() : WindowKeys{};
}

bool Renderer::minimised() const {
  return impl_->window != nullptr && impl_->window->minimised();
}

int Renderer::widthPx() const {
  int widthPx = impl_->options.widthPx, heightPx = 0;
  if (impl_->window != nullptr) impl_->window->sizePx(widthPx, heightPx);
  return widthPx > 0 ? widthPx : impl_->options.widthPx;  // 0: minimised
}

int Renderer::heightPx() const {
  int widthPx = 0, heightPx = impl_->options.heightPx;
  if (impl_->window != nullptr) impl_->window->sizePx(widthPx, heightPx);
  return heightPx > 0 ? heightPx : impl_->options.heightPx;
}

}  // namespace eye
