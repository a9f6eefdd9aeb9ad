#include "render/targets.h"

namespace eye {

std::vector<Targets> createTargets(GpuDevices gpus, int widthPx, int heightPx, vk::Format colourFormat,
                                   vk::SampleCountFlagBits samples) {
  using Use = vk::ImageUsageFlagBits;
  std::vector<Targets> made(gpus.size());
  for (Targets& targets : made) {
    targets.widthPx = widthPx;
    targets.heightPx = heightPx;
    targets.area = wholeOf(targets);
  }
  const auto make = [&](GpuImage Targets::*image, vk::Format format, vk::ImageUsageFlags usage,
                        vk::ImageAspectFlagBits aspect, vk::SampleCountFlagBits count) {
    std::vector<GpuImage> images = createImages(gpus, {.widthPx = widthPx,
                                                       .heightPx = heightPx,
                                                       .format = format,
                                                       .usage = usage,
                                                       .aspect = aspect,
                                                       .samples = count});
    for (size_t i = 0; i < made.size(); ++i) made[i].*image = std::move(images[i]);
  };
  constexpr auto kOne = vk::SampleCountFlagBits::e1;
  constexpr auto kColour = vk::ImageAspectFlagBits::eColor, kDepth = vk::ImageAspectFlagBits::eDepth;
  make(&Targets::colour, colourFormat, Use::eColorAttachment | Use::eTransferSrc, kColour, kOne);
  make(&Targets::depth, kDepthFormat, Use::eDepthStencilAttachment | Use::eTransferSrc, kDepth, kOne);
  if (samples != kOne) {
    make(&Targets::depthSamples, kDepthFormat, Use::eDepthStencilAttachment | Use::eSampled, kDepth, samples);
    make(&Targets::colourSamples, colourFormat, Use::eColorAttachment, kColour, samples);
  }
  const vk::DeviceSize bytes = vk::DeviceSize{4} * static_cast<uint32_t>(widthPx) * static_cast<uint32_t>(heightPx);
  made.front().colourBack =
      createBuffer(*gpus.front(), bytes, vk::BufferUsageFlagBits::eTransferDst, MemoryUse::readBack);
  made.front().depthBack =
      createBuffer(*gpus.front(), bytes, vk::BufferUsageFlagBits::eTransferDst, MemoryUse::readBack);
  return made;
}

vk::Rect2D wholeOf(const Targets& targets) {
  return {{0, 0}, {static_cast<uint32_t>(targets.widthPx), static_cast<uint32_t>(targets.heightPx)}};
}

void recordReadBack(const vk::raii::CommandBuffer& commands, const GpuImage& image, const GpuBuffer& buffer) {
  const vk::Extent3D extent(static_cast<uint32_t>(image.spec.widthPx), static_cast<uint32_t>(image.spec.heightPx), 1);
  const vk::BufferImageCopy copy(0, 0, 0, {image.spec.aspect, 0, 0, 1}, {}, extent);
  commands.copyImageToBuffer(*image.image, vk::ImageLayout::eTransferSrcOptimal, *buffer.buffer, copy);
  recordMemoryBarrier(commands, vk::PipelineStageFlagBits2::eTransfer, vk::AccessFlagBits2::eTransferWrite,
                      vk::PipelineStageFlagBits2::eHost, vk::AccessFlagBits2::eHostRead);
}

}  // namespace eye
