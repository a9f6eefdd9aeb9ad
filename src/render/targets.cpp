#include "render/targets.h"

namespace eye {

Targets createTargets(const GpuDevice& gpu, int widthPx, int heightPx, vk::Format colourFormat,
                      vk::SampleCountFlagBits samples) {
  using Use = vk::ImageUsageFlagBits;
  Targets made;
  made.widthPx = widthPx;
  made.heightPx = heightPx;
  ImageSpec spec;
  spec.widthPx = widthPx;
  spec.heightPx = heightPx;
  spec.format = colourFormat;
  spec.usage = Use::eColorAttachment | Use::eTransferSrc;
  made.colour = createImage(gpu, spec);
  spec.format = kDepthFormat;
  spec.usage = Use::eDepthStencilAttachment | Use::eTransferSrc;
  spec.aspect = vk::ImageAspectFlagBits::eDepth;
  made.depth = createImage(gpu, spec);
  if (samples != vk::SampleCountFlagBits::e1) {
    spec.samples = samples;
    spec.usage = Use::eDepthStencilAttachment | Use::eSampled;
    made.depthSamples = createImage(gpu, spec);
    spec.format = colourFormat;
    spec.usage = Use::eColorAttachment;
    spec.aspect = vk::ImageAspectFlagBits::eColor;
    made.colourSamples = createImage(gpu, spec);
  }
  const vk::DeviceSize bytes = vk::DeviceSize{4} * static_cast<uint32_t>(widthPx) * static_cast<uint32_t>(heightPx);
  made.colourBack = createBuffer(gpu, bytes, vk::BufferUsageFlagBits::eTransferDst, MemoryUse::readBack);
  made.depthBack = createBuffer(gpu, bytes, vk::BufferUsageFlagBits::eTransferDst, MemoryUse::readBack);
  return made;
}

void recordReadBack(const vk::raii::CommandBuffer& commands, const GpuImage& image, const GpuBuffer& buffer) {
  const vk::Extent3D extent(static_cast<uint32_t>(image.spec.widthPx), static_cast<uint32_t>(image.spec.heightPx), 1);
  const vk::BufferImageCopy copy(0, 0, 0, {image.spec.aspect, 0, 0, 1}, {}, extent);
  commands.copyImageToBuffer(*image.image, vk::ImageLayout::eTransferSrcOptimal, *buffer.buffer, copy);
  recordMemoryBarrier(commands, vk::PipelineStageFlagBits2::eTransfer, vk::AccessFlagBits2::eTransferWrite,
                      vk::PipelineStageFlagBits2::eHost, vk::AccessFlagBits2::eHostRead);
}

}  // namespace eye
