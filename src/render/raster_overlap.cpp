#include "render/raster_overlap.h"

#include <algorithm>

namespace eye {
namespace {

// Hand-overs in a frame; further ones are left out.
constexpr uint32_t kMostStamps = 32;
// Batches of a pass. Each costs one more round through all tiles and a moment in which the threads wait for each other:
// 4 to 8 measure the same, fewer overlap less.
constexpr uint32_t kBatches = 6;
constexpr uint32_t kFewestDraws = 8;

}  // namespace

RasterOverlap::RasterOverlap(const GpuDevice& gpu) {
  if (!gpu.traits.binsBeforeRastering) return;
  stamps_ = {gpu.device, vk::QueryPoolCreateInfo({}, vk::QueryType::eTimestamp, kMostStamps)};
}

void RasterOverlap::begin(const vk::raii::CommandBuffer& commands) {
  used_ = 0;
  if (*stamps_) commands.resetQueryPool(*stamps_, 0, kMostStamps);
}

uint32_t RasterOverlap::batch(uint32_t draws) const {
  return *stamps_ ? std::max(kFewestDraws, (draws + kBatches - 1) / kBatches) : std::max(draws, 1u);
}

void RasterOverlap::handOver(const vk::raii::CommandBuffer& commands) {
  if (!*stamps_ || used_ == kMostStamps) return;
  commands.writeTimestamp2(vk::PipelineStageFlagBits2::eBottomOfPipe, *stamps_, used_++);
}

}  // namespace eye
