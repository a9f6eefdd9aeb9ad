// How the renderer comes into being: devices, pools, passes, and a first draw of every pipeline.
#include <fmt/format.h>

#include <thread>

#include "gpu/pipeline_cache.h"
#include "gpu/time_slices.h"
#include "render/renderer_impl.h"
#include "render/warm_up.h"

namespace eye {
namespace {

// A device that is a CPU has more threads than cores, and whichever waits for a core that another keeps for some
// milliseconds holds up all of them. The shortest that Linux takes.
constexpr std::chrono::microseconds kSlice{100};

vk::SampleCountFlagBits sampleCount(const RendererOptions& options) {
  return options.samples > 1 ? vk::SampleCountFlagBits::e4 : vk::SampleCountFlagBits::e1;
}

bool drawsSamples(const GpuDevice& gpu, vk::SampleCountFlagBits samples) {
  return static_cast<bool>(gpu.traits.sampleCounts & samples);
}

bool cullsOnHost(const RendererOptions& options, const GpuDevice& gpu) {
  return options.cullBy == CullBy::host || (options.cullBy == CullBy::device && gpu.traits.cullsOnHost);
}

// Bands where devices turn out to be a CPU's. Shaders that cull see one picture, and boxes are not bent with the scene.
BandPlan bandPlan(const RendererOptions& options) {
  if (options.cullBy == CullBy::compute || options.bend) return {};
  return planBands(options.bands, static_cast<int>(std::thread::hardware_concurrency()));
}

using Gpus = std::vector<std::unique_ptr<GpuDevice>>;

Result<void> addDevice(const DeviceOptions& options, Gpus& gpus) {
  auto gpu = createDevice(options);
  if (!gpu) return tl::unexpected(gpu.error());
  gpus.push_back(std::move(*gpu));
  return {};
}

// One device, or as many of a CPU as are planned, as long as it has memory for them.
Result<Gpus> createDevices(const RendererOptions& options) {
  const BandPlan plan = bandPlan(options);
  DeviceOptions asked{options.device, options.validate, options.window};
  Gpus gpus;
  if (plan.bands > 1) {
    const RasterThreads threads(plan.rasterThreads);
    asked.oneOfSeveral = true;
    if (auto made = addDevice(asked, gpus); !made) return tl::unexpected(made.error());
    const GpuDevice& first = *gpus.front();
    if (!first.traits.isCpu) return gpus;
    const DeviceOptions other{first.description.name, options.validate, false, true};
    while (first.traits.sharedMemoryAlignment > 0 && gpus.size() < static_cast<size_t>(plan.bands) &&
           addDevice(other, gpus)) {
    }
    if (gpus.size() > 1) return gpus;
    gpus.clear();  // one for all then, with all threads
    asked.oneOfSeveral = false;
  }
  if (auto made = addDevice(asked, gpus); !made) return tl::unexpected(made.error());
  return gpus;
}

}  // namespace

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
    auto gpus = createDevices(options);
    if (!gpus) return tl::unexpected(gpus.error());
    impl->gpus = std::move(*gpus);
    const GpuDevice& device = impl->gpu();
    if (!device.traits.isCpu) askForSlices({});
    if (!drawsSamples(device, sampleCount(options)))
      return fail(ErrorKind::unsupported, fmt::format("{} draws no pictures with {} samples a pixel: give --samples 1",
                                                      device.description.name, options.samples));
    if (options.filter == TextureFilter::anisotropic && device.traits.mostAnisotropy <= 1)
      return fail(ErrorKind::unsupported,
                  fmt::format("{} has no anisotropic filter: give --sampler trilinear", device.description.name));
    const bool onHost = cullsOnHost(options, device);
    auto pools = ChunkPools::create(impl->gpus, options.gpuBudgetBytes, options.textureSize, onHost);
    if (!pools) return tl::unexpected(pools.error());
    impl->pools = std::move(*pools);

    if (options.window) impl->swapchain = std::make_unique<Swapchain>(device, *impl->window, options.vsync);

    const SceneOptions scene{.colourFormat = impl->colourFormat(),
                             .samples = sampleCount(options),
                             .filter = options.filter,
                             .withTints = options.debugViews,
                             .bend = options.bend};
    for (size_t i = 0; i < impl->gpus.size(); ++i) {
      impl->bands.push_back(std::make_unique<Band>(*impl->gpus[i], scene, impl->gpus.size() == 1));
      impl->bands.back()->scene.bindTextures(*impl->gpus[i], impl->pools->textures(i));
    }
    const vk::raii::PipelineCache& cache = impl->first().cache;
    impl->lists = std::make_unique<DrawLists>(impl->gpus);
    impl->cullLists = std::make_unique<CullLists>(impl->gpus, onHost);
    if (!onHost) {
      impl->cull = std::make_unique<CullPass>(device, cache);
      impl->cull->bind(device, *impl->pools, *impl->cullLists);
      runOnce(device, [&](const vk::raii::CommandBuffer& commands) { impl->cull->recordWarmUp(commands); });
    }
    if (options.debugViews) {
      impl->debug = std::make_unique<DebugViews>(device, cache, impl->colourFormat());
      impl->debug->bind(device, *impl->cullLists);
    }
    GLFWwindow* window = options.window ? impl->window->handle() : nullptr;
    impl->overlay = std::make_unique<Overlay>(device, cache, impl->colourFormat(), window);

    std::unique_ptr<Renderer> renderer(new Renderer(std::move(impl)));
    if (auto warm = warmUp(*renderer, options); !warm) return tl::unexpected(warm.error());
    savePipelineCache(renderer->impl_->first().cache, renderer->impl_->first().cachePath);
    return renderer;
  } catch (const std::exception& e) {
    return fail(ErrorKind::unsupported,
                fmt::format("the graphics device refuses to start ({}): try a smaller --cache-gpu or --size, "
                            "or another --device",
                            e.what()));
  }
}

}  // namespace eye
