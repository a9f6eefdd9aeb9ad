// Lets a device that is a CPU rasterise the first draws of a pass while it still bins the later ones.
#pragma once

#include "gpu/device.h"

namespace eye {

// llvmpipe bins every draw of a render pass on one thread before its others begin to rasterise, unless something asks
// for what was drawn so far. A time stamp within the pass asks: the bins are handed over, nothing waits, and the
// binning of the next draws goes on. On two cores that takes 5 to 10 % off the wall time of a frame of mountains; the
// two shorter passes of a frame with a depth map lose 3 % by it. Other devices overlap by themselves: there this does
// nothing.
class RasterOverlap {
 public:
  explicit RasterOverlap(const GpuDevice& gpu);

  // Once a frame, outside a render pass.
  void begin(const vk::raii::CommandBuffer& commands);
  // Draws to record between two calls of handOver, for a pass of `draws` in all.
  uint32_t batch(uint32_t draws) const;
  // Within a render pass, after a batch.
  void handOver(const vk::raii::CommandBuffer& commands);

 private:
  vk::raii::QueryPool stamps_{nullptr};  // null where it does nothing; the times are never read
  uint32_t used_ = 0;
};

}  // namespace eye
