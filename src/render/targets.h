// The images that a frame is drawn into and the buffers that it is read back through, all of one size.
#pragma once

#include "gpu/barrier.h"

namespace eye {

inline constexpr vk::Format kDepthFormat = vk::Format::eD32Sfloat;

struct Targets {
  int widthPx = 0, heightPx = 0;
  vk::Rect2D area;  // of them, that is drawn
  GpuImage colour, depth;
  // Of pictures with several samples a pixel, else null: colour is their mean, depth is drawn by itself.
  GpuImage colourSamples, depthSamples;
  GpuBuffer colourBack, depthBack;  // of the first device
  bool isSampled() const { return static_cast<bool>(*colourSamples.image); }
};

// The same ones for each device, to be drawn whole. Throws vk::SystemError where memory is short or the size is beyond
// the device's.
std::vector<Targets> createTargets(GpuDevices gpus, int widthPx, int heightPx, vk::Format colourFormat,
                                   vk::SampleCountFlagBits samples);

// All of them, as an area.
vk::Rect2D wholeOf(const Targets& targets);

// Copies an image that is in usageCopySource to its buffer and makes that visible to the CPU.
void recordReadBack(const vk::raii::CommandBuffer& commands, const GpuImage& image, const GpuBuffer& buffer);

}  // namespace eye
