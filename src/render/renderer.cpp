#include "render/renderer.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "render/frame_data.h"
#include "render/haze_width.h"
#include "render/renderer_impl.h"
#include "telemetry/cpu_time.h"
#include "telemetry/trace.h"

namespace eye {

namespace {

// Pixels of the picture under a texel of the depth map, each way: lavapipe ends a shader's loops after 65,535 rounds.
constexpr int kMostPixelsPerTexel = 128;

glm::ivec2 usableMap(glm::ivec2 mapPx, glm::ivec2 picturePx) {
  return glm::max(mapPx, (picturePx + (kMostPixelsPerTexel - 1)) / kMostPixelsPerTexel);
}

// In the trace, by band.
constexpr std::array<const char*, kMostBands> kTraceLanes{"GPU", "GPU 2", "GPU 3", "GPU 4"};

glm::vec3 clipRow(const shader::FrameData& data, int row) {
  const glm::mat4& m = data.clipFromEcef;
  return {m[0][row], m[1][row], m[2][row]};
}

template <class T>
std::vector<T> copyOf(std::span<const T> values) {
  return {values.begin(), values.end()};
}

}  // namespace

Renderer::Renderer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

Renderer::~Renderer() {
  for (const auto& gpu : impl_->gpus)
    (void)vkDeviceWaitIdle(*gpu->device);  // shutdown; vk::raii would throw where the device is lost
}

Result<std::vector<DeviceDescription>> Renderer::listDevices() {
  return eye::listDevices();
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
  return impl_->gpu().description;
}
TextureFilter Renderer::textureFilter() const {
  return filterOn(impl_->gpu(), impl_->options.filter);
}
uint64_t Renderer::validationMessages() const {
  uint64_t messages = 0;
  for (const auto& gpu : impl_->gpus) messages += gpu->messages.load();
  return messages;
}

Result<bool> Renderer::awaitDisplay() {
  if (impl_->swapchain == nullptr) return false;
  const TraceScope scope("wait for the display");
  try {
    return impl_->swapchain->acquire(impl_->gpu());
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
    impl.lists->reserve(impl.gpus, input.draws.size());
    const shader::FrameData data = frameData(input);
    const size_t used = impl.placeBands(input, data);
    const size_t parted = partByHaze(asked.draws, asked.view.eyeEcefM, data, impl.draws);
    const size_t byVertex = impl.options.airByPixel ? 0 : parted;
    input.draws = impl.draws;
    const BandTest bandTest(impl.edgesPx, clipRow(data, 0), clipRow(data, 3));
    const DrawCounts counts =
        impl.lists->write(input.draws, byVertex, input.view.eyeEcefM, impl.options.textureSize, bandTest);
    if (impl.debug) impl.debug->prepare(impl.gpu(), input, *impl.pools, *impl.cullLists, impl.options.textureSize);
    const bool culls = impl.prepareCulling(input, data, byVertex);
    std::optional<uint32_t> shown;
    if (impl.swapchain != nullptr) shown = impl.swapchain->held();
    {
      const TraceScope scope("record");
      for (size_t i = 0; i < used; ++i) impl.bands[i]->begin();
      impl.upload();
      culls ? impl.drawCulledScene(input, counts, bandTest, used) : impl.drawScene(input, counts, used);
      if (input.readDepth && impl.targets().isSampled())
        for (size_t i = 0; i < used; ++i) impl.bands[i]->drawDepthAtCentres(impl.drawsOf(i), counts.draws());
    }
    if (impl.isInBands()) impl.joinBands(used);
    impl.finish(input, shown);
    impl.pools->staged();
    impl.drawn = true;

    FrameOutput output;
    if (impl.gpu().traits.isCpu) output.cpuMs = processCpuMs() - cpuBeganMs;
    output.widthPx = impl.targets().widthPx;
    output.heightPx = impl.targets().heightPx;
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
    if (input.readDepth) output.depth = impl.targets().depthBack.as<const float>();
    impl.readTimes(used, output);
    output.completedNs = monotonicNs();
    if (shown) impl.swapchain->present(impl.gpu());
    return output;
  } catch (const std::exception& e) {
    return fail(ErrorKind::unsupported,
                fmt::format("the graphics device failed while drawing ({}): start again, perhaps with "
                            "another --device",
                            e.what()));
  }
}

void Renderer::Impl::resizeTargets(int widthPx, int heightPx) {
  if (widthPx == targets().widthPx && heightPx == targets().heightPx) return;
  for (const auto& band : bands) band->targets = {};  // the old ones first: both at once may not fit
  drawn = false;
  const auto samples = first().farthest ? vk::SampleCountFlagBits::e4 : vk::SampleCountFlagBits::e1;
  std::vector<Targets> made = createTargets(gpus, widthPx, heightPx, colourFormat(), samples);
  for (size_t i = 0; i < bands.size(); ++i) bands[i]->targets = std::move(made[i]);
  bindDepth();
  overlay->bindTargets(gpu(), targets());
  edgesPx = evenEdges(widthPx, static_cast<int>(bands.size()), seamStepPx(options.samples));
}

void Renderer::Impl::bindDepth() {
  for (size_t i = 0; i < bands.size(); ++i)
    if (bands[i]->farthest) bands[i]->farthest->bind(*gpus[i], bands[i]->targets, cullLists->depthBuffer(i));
}

// How many of the bands the picture has columns for.
size_t Renderer::Impl::placeBands(const FrameInput& input, const shader::FrameData& data) {
  size_t used = 0;
  for (; used < bands.size() && edgesPx[used] < edgesPx[used + 1]; ++used) {
    const auto width = static_cast<uint32_t>(edgesPx[used + 1] - edgesPx[used]);
    const vk::Rect2D area({edgesPx[used], 0}, {width, static_cast<uint32_t>(input.view.heightPx)});
    bands[used]->place(input, data, area, options.airByPixel);
  }
  return used;
}

// False: nothing to test, or more than the device's buffers hold: the frame is drawn without the pass.
bool Renderer::Impl::prepareCulling(const FrameInput& input, const shader::FrameData& data, size_t byVertex) {
  if (!input.depthMapPx) return false;
  const glm::ivec2 picturePx(input.view.widthPx, input.view.heightPx);
  const glm::ivec2 mapPx = usableMap(*input.depthMapPx, picturePx);
  if (!CullLists::fits(gpu(), input.draws, picturePx, mapPx)) return false;
  if (cullLists->reserve(gpus, input.draws, picturePx, mapPx)) {
    if (cull) cull->bind(gpu(), *pools, *cullLists);
    bindDepth();
    if (debug) debug->bind(gpu(), *cullLists);
  }
  cullLists->write(input.draws, byVertex, input.view, data.clipFromEcef, mapPx, input.freezeCulling);
  return cullLists->candidateCount() > 0;
}

// With the first commands of the only device; before all of them where several are to see it.
void Renderer::Impl::upload() {
  if (isInBands()) {
    const int64_t beganNs = monotonicNs();
    pools->flush();
    hostUploadMs = static_cast<double>(monotonicNs() - beganNs) * 1e-6;
  } else {
    pools->recordUploads(first().frame.commands());
  }
  first().timestamps.mark(first().frame.commands(), "upload");
}

IndirectDraws Renderer::Impl::drawsOf(size_t band) const {
  return {.commands = *lists->commands(band).buffer,
          .indices = *pools->indexBuffer(band).buffer,
          .vertices = *pools->vertexBuffer(band).buffer,
          .records = *lists->draws(band).buffer};
}

void Renderer::Impl::drawScene(const FrameInput& input, const DrawCounts& counts, size_t used) {
  std::vector<uint32_t> handOvers;
  if (first().overlap)
    handOvers = first().overlap->handOvers(lists->commands().as<const shader::DrawCommand>().first(counts.draws()));
  for (size_t i = 0; i < used; ++i) bands[i]->drawScene(input, drawsOf(i), counts, handOvers);
}

// Waits until each band is complete. What follows is for the first device, over the whole picture.
void Renderer::Impl::joinBands(size_t used) {
  for (size_t i = 0; i < used; ++i) bands[i]->frame.submit(*gpus[i]);
  for (size_t i = 0; i < used; ++i) bands[i]->wait();
  targets().area = wholeOf(targets());
}

// What is drawn over the scene, the copies that are asked for, and the wait for all of it.
void Renderer::Impl::finish(const FrameInput& input, std::optional<uint32_t> shown) {
  Band& band = first();
  const vk::raii::CommandBuffer& commands = band.frame.commands();
  if (isInBands()) {
    const bool isComplete = !debug && !input.overlay && !input.readColour && !input.readDepth && swapchain == nullptr;
    if (isComplete) return;
    band.frame.begin();
    band.timestamps.skip(commands);
  }
  // Tints are drawn over the whole picture.
  if (isInBands() && input.tint != Tint::none) band.scene.placeSky(input, input.view, options.airByPixel);
  if (debug) debug->record(commands, gpu(), input, band.scene, *pools, targets(), *cullLists, band.timestamps);
  if (input.overlay) {
    overlay->record(commands, targets(), input.overlay);
    band.timestamps.mark(commands, "overlay");
  }
  const std::array toCopy{imageBarrier(targets().colour, usageColourTarget(), usageCopySource())};
  recordBarriers(commands, toCopy);
  if (input.readColour) recordReadBack(commands, targets().colour, targets().colourBack);
  if (input.readDepth) {
    const std::array depthToCopy{imageBarrier(targets().depth, usageDepthTarget(), usageCopySource())};
    recordBarriers(commands, depthToCopy);
    recordReadBack(commands, targets().depth, targets().depthBack);
  }
  if (input.readColour || input.readDepth) band.timestamps.mark(commands, "read_back");
  if (shown) {
    swapchain->recordCopy(commands, targets().colour, *shown);
    band.timestamps.mark(commands, "present");
  }
  band.frame.submit(gpu());
  isInBands() ? band.frame.wait(gpu()) : band.wait();
}

// Of each pass the longest of the bands' times. Devices that share a picture have a clock in common.
void Renderer::Impl::readTimes(size_t used, FrameOutput& output) {
  // It is tied to ours by the end of the frame, which the last fence has just told.
  const int64_t endNs = monotonicNs();
  passTimes.clear();
  double beginMs = std::numeric_limits<double>::infinity(), endMs = 0;
  for (size_t i = 0; i < used; ++i) {
    const auto& spans = bands[i]->readTimes();
    if (spans.empty()) continue;
    beginMs = std::min(beginMs, bands[i]->timestamps.beginMs());
    endMs = std::max(endMs, bands[i]->timestamps.beginMs() + spans.back().endMs);
  }
  output.gpuMs = std::max(endMs - beginMs, 0.0);
  for (size_t i = 0; i < used; ++i) {
    const double sinceMs = bands[i]->timestamps.beginMs();
    const auto at = [&](double ms) { return endNs - static_cast<int64_t>((endMs - (sinceMs + ms)) * 1e6); };
    for (const Timestamps::Span& span : bands[i]->timestamps.spans()) {
      const std::optional<double> byHost = hostMs(span.name);
      addPassTime(span.name, byHost.value_or(span.endMs - span.beginMs));
      if (!byHost) traceSpan(kTraceLanes[i], span.name, at(span.beginMs), at(span.endMs));  // else the render thread's
    }
  }
  if (isInBands() && used == bands.size()) {
    std::vector<double> ms;
    for (const auto& band : bands) ms.push_back(band->busyMs());
    edgesPx = balancedEdges(edgesPx, ms, seamStepPx(options.samples));
  }
  output.passes = passTimes;
}

void Renderer::Impl::addPassTime(const char* name, double ms) {
  const auto known = std::ranges::find(passTimes, std::string_view(name), &PassTime::name);
  if (known == passTimes.end()) {
    passTimes.push_back({name, ms});
  } else {
    known->ms = std::max(known->ms, ms);
  }
}

// Of a pass that the CPU does here.
std::optional<double> Renderer::Impl::hostMs(std::string_view pass) const {
  if (isInBands() && pass == "upload") return hostUploadMs;
  if (!cullLists->onHost()) return std::nullopt;
  if (pass == "cull_early") return hostEarlyMs;
  if (pass == "cull_late") return hostLateMs;
  return std::nullopt;
}

vk::Format Renderer::Impl::colourFormat() const {
  const bool asWindow = swapchain != nullptr && swapchain->format() == vk::Format::eB8G8R8A8Unorm;
  return asWindow ? vk::Format::eB8G8R8A8Unorm : vk::Format::eR8G8B8A8Unorm;
}

std::span<const uint8_t> Renderer::Impl::pictureRgba() {
  const std::span<const uint8_t> read = targets().colourBack.as<const uint8_t>();
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
  const GpuDevice& gpu = impl_->gpu();
  const CullLists& lists = *impl_->cullLists;
  const size_t candidates = lists.candidateCount();
  const shader::CullParams params = lists.params();
  const auto pixels = static_cast<size_t>(params.picturePx.x) * static_cast<size_t>(params.picturePx.y);
  std::vector<CullReadBack::BandDraws> bands;
  for (size_t i = 0; i < impl_->gpus.size(); ++i)
    bands.push_back({readBuffer<shader::DrawCommand>(*impl_->gpus[i], lists.earlyBuffer(i), candidates),
                     readBuffer<shader::DrawCommand>(*impl_->gpus[i], lists.lateBuffer(i), candidates),
                     lists.onHost() ? copyOf(lists.packedIndices(i).as<const uint16_t>()) : std::vector<uint16_t>{}});
  return {
      .params = params,
      .chunks = readBuffer<shader::CullChunk>(gpu, lists.chunksBuffer(), lists.chunkCount()),
      .candidates = readBuffer<shader::CullCandidate>(gpu, lists.candidatesBuffer(), candidates),
      .clusters =
          readBuffer<shader::ClusterRecord>(gpu, impl_->pools->clusterBuffer(), impl_->pools->clusterCapacity()),
      .bands = std::move(bands),
      .edgesPx = impl_->edgesPx,
      .fates = readBuffer<uint32_t>(gpu, lists.fatesBuffer(), candidates),
      .depth = readBuffer<float>(gpu, lists.depthBuffer(), pixels),
      .pyramid = readBuffer<float>(gpu, lists.pyramidBuffer(), pyramidLayout(params.mapPx).texels),
      .indices = lists.onHost() ? copyOf(impl_->pools->indexBuffer().as<const uint16_t>()) : std::vector<uint16_t>{},
      .visibleTriangles = copyOf(lists.visibleTriangles())};
}

void Renderer::presentAgain() {
  Impl& impl = *impl_;
  if (impl.swapchain == nullptr || !impl.drawn) return;
  const std::optional<uint32_t> shown = impl.swapchain->held();
  if (!shown) return;
  try {
    const Submission& frame = impl.first().frame;
    frame.begin();
    impl.swapchain->recordCopy(frame.commands(), impl.targets().colour, *shown);
    frame.submit(impl.gpu());
    frame.wait(impl.gpu());
    impl.swapchain->present(impl.gpu());
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
