// Lets a device that is a CPU rasterise the first draws of a pass while it still bins the later ones.
#pragma once

#include <span>
#include <vector>

#include "gpu/device.h"
#include "shared/cull_types.h"

namespace eye {

// Of the draws of a pass, those before which to hand over, ascending: where a quarter, half and three quarters of the
// indices are binned.
std::vector<uint32_t> handOversOf(std::span<const shader::DrawCommand> draws);

// llvmpipe bins every draw of a render pass on one thread before its others begin to rasterise, unless something asks
// for what was drawn so far. A time stamp within the pass asks: the bins are handed over, nothing waits, and the
// binning of the next draws goes on. On two cores that takes up to 10 % off the wall time of a frame. Other devices
// overlap by themselves: there this does nothing.
class RasterOverlap {
 public:
  explicit RasterOverlap(const GpuDevice& gpu);

  // Once a frame, outside a render pass.
  void begin(const vk::raii::CommandBuffer& commands);
  // As handOversOf; none on other devices.
  std::vector<uint32_t> handOvers(std::span<const shader::DrawCommand> draws) const;
  // Within a render pass.
  void handOver(const vk::raii::CommandBuffer& commands);

 private:
  vk::raii::QueryPool stamps_{nullptr};  // null where it does nothing; the times are never read
  uint32_t used_ = 0;
};

}  // namespace eye
