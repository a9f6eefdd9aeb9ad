#include "gpu/memory.h"

#include <cstring>

namespace eye {
namespace {

// The first memory type that has all of the wanted properties, trying the lists in order.
uint32_t findMemoryType(const GpuDevice& gpu, uint32_t allowedBits,
                        std::initializer_list<vk::MemoryPropertyFlags> wishes) {
  for (const vk::MemoryPropertyFlags wish : wishes) {
    for (uint32_t i = 0; i < gpu.memory.memoryTypeCount; ++i) {
      const bool allowed = (allowedBits & (1u << i)) != 0;
      if (allowed && (gpu.memory.memoryTypes[i].propertyFlags & wish) == wish) return i;
    }
  }
  throw vk::OutOfDeviceMemoryError("no memory type fits");
}

uint32_t findMemoryType(const GpuDevice& gpu, uint32_t allowedBits, MemoryUse use) {
  using Flag = vk::MemoryPropertyFlagBits;
  constexpr vk::MemoryPropertyFlags kVisible = Flag::eHostVisible | Flag::eHostCoherent;
  switch (use) {
    case MemoryUse::device:
      return findMemoryType(gpu, allowedBits, {Flag::eDeviceLocal, vk::MemoryPropertyFlags{}});
    case MemoryUse::upload:
      return findMemoryType(gpu, allowedBits, {kVisible});
    case MemoryUse::readBack:
      return findMemoryType(gpu, allowedBits, {kVisible | Flag::eHostCached, kVisible});
  }
  throw vk::OutOfDeviceMemoryError("unknown use");
}

}  // namespace

GpuBuffer createBuffer(const GpuDevice& gpu, vk::DeviceSize size, vk::BufferUsageFlags usage, MemoryUse use) {
  GpuBuffer made;
  made.size = size;
  made.buffer = vk::raii::Buffer(gpu.device, vk::BufferCreateInfo({}, size, usage));
  const vk::MemoryRequirements needs = made.buffer.getMemoryRequirements();
  made.memory = vk::raii::DeviceMemory(
      gpu.device, vk::MemoryAllocateInfo(needs.size, findMemoryType(gpu, needs.memoryTypeBits, use)));
  made.buffer.bindMemory(*made.memory, 0);
  if (use != MemoryUse::device) made.mapped = static_cast<std::byte*>(made.memory.mapMemory(0, VK_WHOLE_SIZE));
  return made;
}

GpuImage createImage(const GpuDevice& gpu, const ImageSpec& spec) {
  GpuImage made;
  made.spec = spec;
  vk::ImageCreateInfo info;
  info.setImageType(vk::ImageType::e2D).setFormat(spec.format).setUsage(spec.usage);
  info.setExtent({static_cast<uint32_t>(spec.widthPx), static_cast<uint32_t>(spec.heightPx), 1});
  info.setMipLevels(spec.mipLevels).setArrayLayers(spec.layers).setSamples(spec.samples);
  made.image = vk::raii::Image(gpu.device, info);
  const vk::MemoryRequirements needs = made.image.getMemoryRequirements();
  made.bytes = needs.size;
  made.memory = vk::raii::DeviceMemory(
      gpu.device, vk::MemoryAllocateInfo(needs.size, findMemoryType(gpu, needs.memoryTypeBits, MemoryUse::device)));
  made.image.bindMemory(*made.memory, 0);
  const vk::ImageSubresourceRange all(spec.aspect, 0, spec.mipLevels, 0, spec.layers);
  const auto type = spec.array ? vk::ImageViewType::e2DArray : vk::ImageViewType::e2D;
  made.view = vk::raii::ImageView(gpu.device, vk::ImageViewCreateInfo({}, *made.image, type, spec.format, {}, all));
  return made;
}

void readBytes(const GpuDevice& gpu, const GpuBuffer& buffer, std::span<std::byte> to) {
  if (to.empty()) return;
  EYE_CHECK(to.size() <= buffer.size);
  if (buffer.mapped != nullptr) {
    std::memcpy(to.data(), buffer.mapped, to.size());
    return;
  }
  const GpuBuffer staging = createBuffer(gpu, to.size(), vk::BufferUsageFlagBits::eTransferDst, MemoryUse::readBack);
  runOnce(gpu, [&](const vk::raii::CommandBuffer& commands) {
    commands.copyBuffer(*buffer.buffer, *staging.buffer, vk::BufferCopy(0, 0, to.size()));
    const vk::MemoryBarrier2 toHost(vk::PipelineStageFlagBits2::eTransfer, vk::AccessFlagBits2::eTransferWrite,
                                    vk::PipelineStageFlagBits2::eHost, vk::AccessFlagBits2::eHostRead);
    vk::DependencyInfo info;
    info.setMemoryBarriers(toHost);
    commands.pipelineBarrier2(info);
  });
  std::memcpy(to.data(), staging.mapped, to.size());
}

}  // namespace eye
