#include "bench/machine_speed.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "gpu/barrier.h"
#include "gpu/pipeline.h"
#include "shared/speed.h"
#include "spirv/speed_frag.h"
#include "spirv/speed_vert.h"
#include "telemetry/cpu_time.h"

namespace eye {
namespace {

constexpr int kWidthPx = 800, kHeightPx = 600;
constexpr vk::Format kFormat = vk::Format::eR8G8B8A8Unorm;
constexpr int kRuns = 9, kFramesARun = 8;
constexpr size_t kTableWords = size_t{2} << 20;  // 8 MiB: more than a core's own caches
constexpr int kSteps = 4'000'000;

double median(std::array<double, kRuns> values) {
  std::ranges::sort(values);
  return values[kRuns / 2];
}

// Each step's place in the table hangs on the last one's arithmetic.
double loopMs(const std::vector<uint32_t>& table) {
  const double begin = threadCpuMs();
  uint32_t at = 1;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    at = at * 1664525u + 1013904223u;
    const uint32_t word = table[(at >> 8) % kTableWords];
    sum = sum * 0.999 + static_cast<double>(word);
    if ((word & 3u) == 0) at ^= word;
  }
  const double ms = threadCpuMs() - begin;
  return sum > -1 ? ms : 0;  // the sum is used, so that the loop stays
}

}  // namespace

double MachineSpeed::referenceMs() const {
  return drawMs ? std::sqrt(loopMs * *drawMs) : loopMs;
}

MachineSpeed meanOf(const MachineSpeed& a, const MachineSpeed& b) {
  MachineSpeed mean{.loopMs = (a.loopMs + b.loopMs) / 2};
  if (a.drawMs && b.drawMs) mean.drawMs = (*a.drawMs + *b.drawMs) / 2;
  return mean;
}

struct SpeedReference::Frame {
  std::unique_ptr<GpuDevice> gpu;
  GpuImage target;
  vk::raii::PipelineLayout layout{nullptr};
  vk::raii::PipelineCache cache{nullptr};
  vk::raii::Pipeline pipeline{nullptr};

  explicit Frame(std::unique_ptr<GpuDevice> device) : gpu(std::move(device)) {
    target = createImage(*gpu, {kWidthPx, kHeightPx, kFormat, vk::ImageUsageFlagBits::eColorAttachment});
    layout = vk::raii::PipelineLayout(gpu->device, vk::PipelineLayoutCreateInfo{});
    cache = vk::raii::PipelineCache(gpu->device, vk::PipelineCacheCreateInfo{});
    PipelineSpec spec;
    spec.vertexSpirv = k_speed_vert;
    spec.fragmentSpirv = k_speed_frag;
    spec.layout = *layout;
    spec.colourFormat = kFormat;
    pipeline = createPipeline(*gpu, cache, spec);
  }

  void draw() {
    runOnce(*gpu, [this](const vk::raii::CommandBuffer& commands) {
      const std::array begin{imageBarrier(target, usageDiscarded(vk::PipelineStageFlagBits2::eColorAttachmentOutput),
                                          usageColourTarget())};
      recordBarriers(commands, begin);
      vk::RenderingAttachmentInfo colour;
      colour.setImageView(*target.view).setImageLayout(vk::ImageLayout::eColorAttachmentOptimal);
      colour.setLoadOp(vk::AttachmentLoadOp::eClear).setStoreOp(vk::AttachmentStoreOp::eStore);
      const vk::Rect2D area({0, 0}, {kWidthPx, kHeightPx});
      vk::RenderingInfo info;
      info.setRenderArea(area).setLayerCount(1).setColorAttachments(colour);
      commands.beginRendering(info);
      commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *pipeline);
      commands.setViewport(0, vk::Viewport(0, 0, kWidthPx, kHeightPx, 0, 1));
      commands.setScissor(0, area);
      commands.draw(EYE_SPEED_VERTICES, 1, 0, 0);
      commands.endRendering();
    });
  }
};

SpeedReference::SpeedReference() = default;
SpeedReference::SpeedReference(SpeedReference&&) noexcept = default;
SpeedReference& SpeedReference::operator=(SpeedReference&&) noexcept = default;
SpeedReference::~SpeedReference() = default;

Result<SpeedReference> SpeedReference::create(const std::string& device) {
  auto gpu = createDevice({.name = device});
  if (!gpu) return tl::unexpected(gpu.error());
  SpeedReference made;
  // What a GPU draws takes no CPU time.
  if (!(*gpu)->traits.isCpu) return made;
  try {
    made.frame_ = std::make_unique<Frame>(std::move(*gpu));
  } catch (const vk::SystemError& e) {
    return fail(ErrorKind::device, fmt::format("the speed reference cannot be drawn: {}", e.what()));
  }
  return made;
}

Result<MachineSpeed> SpeedReference::measure() {
  std::vector<uint32_t> table(kTableWords);
  for (size_t i = 0; i < kTableWords; ++i) table[i] = static_cast<uint32_t>(i) * 2654435761u;
  std::array<double, kRuns> loops{}, draws{};
  try {
    if (frame_) frame_->draw();  // what the first one prepares is not counted
    for (size_t run = 0; run < kRuns; ++run) {
      loops[run] = loopMs(table);
      if (!frame_) continue;
      const double begin = processCpuMs();
      for (int i = 0; i < kFramesARun; ++i) frame_->draw();
      draws[run] = (processCpuMs() - begin) / kFramesARun;
    }
  } catch (const vk::SystemError& e) {
    return fail(ErrorKind::device, fmt::format("the speed reference cannot be drawn: {}", e.what()));
  }
  MachineSpeed speed{.loopMs = median(loops)};
  if (frame_) speed.drawMs = median(draws);
  return speed;
}

}  // namespace eye
