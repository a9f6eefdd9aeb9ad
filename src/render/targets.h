// The images that a frame is drawn into and the buffers that it is read back through, all of one size.
#pragma once

#include "gpu/barrier.h"

namespace eye {

inline constexpr vk::Format kDepthFormat = vk::Format::eD32Sfloat;

struct Targets {
  int widthPx = 0, heightPx = 0;
  GpuImage colour, depth;
  // Of pictures with several samples a pixel, else null: colour is their mean, depth is drawn by itself.
  GpuImage colourSamples, depthSamples;
  GpuBuffer colourBack, depthBack;
  bool isSampled() const { return static_cast<bool>(*colourSamples.image); }
};

// Throws vk::SystemError where memory is short or the size is beyond the device's.
Targets createTargets(const GpuDevice& gpu, int widthPx, int heightPx, vk::Format colourFormat,
                      vk::SampleCountFlagBits samples);

// Copies an image that is in usageCopySource to its buffer and makes that visible to the CPU.
void recordReadBack(const vk::raii::CommandBuffer& commands, const GpuImage& image, const GpuBuffer& buffer);

}  // namespace eye
