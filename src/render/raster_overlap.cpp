#include "render/raster_overlap.h"

#include <array>

namespace eye {
namespace {

// Hand-overs in a frame; further ones are left out.
constexpr uint32_t kMostStamps = 32;
// Of a pass's indices, how many are binned when a batch is handed over. Nothing is rasterised before the first, and
// each costs one more round through all tiles and a moment in which the threads wait for each other: of 4, 8 and 16
// equal batches 4 overlap best, and shares that begin with 5 or 10 % do no better.
constexpr std::array kShares{0.25, 0.5, 0.75};

}  // namespace

std::vector<uint32_t> handOversOf(std::span<const shader::DrawCommand> draws) {
  double all = 0, before = 0;
  for (const shader::DrawCommand& draw : draws) all += draw.indexCount;
  std::vector<uint32_t> found;
  auto share = kShares.begin();
  for (uint32_t i = 0; i < draws.size(); ++i) {
    const auto isReached = [&] { return share != kShares.end() && before > 0 && before >= *share * all; };
    if (isReached()) found.push_back(i);
    while (isReached()) ++share;
    before += draws[i].indexCount;
  }
  return found;
}

RasterOverlap::RasterOverlap(const GpuDevice& gpu) {
  if (!gpu.traits.binsBeforeRastering) return;
  stamps_ = {gpu.device, vk::QueryPoolCreateInfo({}, vk::QueryType::eTimestamp, kMostStamps)};
}

void RasterOverlap::begin(const vk::raii::CommandBuffer& commands) {
  used_ = 0;
  if (*stamps_) commands.resetQueryPool(*stamps_, 0, kMostStamps);
}

std::vector<uint32_t> RasterOverlap::handOvers(std::span<const shader::DrawCommand> draws) const {
  return *stamps_ ? handOversOf(draws) : std::vector<uint32_t>{};
}

void RasterOverlap::handOver(const vk::raii::CommandBuffer& commands) {
  if (!*stamps_ || used_ == kMostStamps) return;
  commands.writeTimestamp2(vk::PipelineStageFlagBits2::eBottomOfPipe, *stamps_, used_++);
}

}  // namespace eye
