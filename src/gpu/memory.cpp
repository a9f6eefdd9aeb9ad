#include "gpu/memory.h"

#include <sys/mman.h>

#include <cstring>

namespace eye {
namespace {

constexpr auto kHostAllocation = vk::ExternalMemoryHandleTypeFlagBits::eHostAllocationEXT;

vk::DeviceSize roundUp(vk::DeviceSize value, vk::DeviceSize multiple) {
  return (value + multiple - 1) / multiple * multiple;
}

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

// Memory of the process for what the first device needs; the others find it made.
void provide(const GpuDevice& gpu, vk::DeviceSize bytes, HostMemory& host) {
  if (host.place) {
    EYE_CHECK(bytes <= host.bytes);  // all of one driver
    return;
  }
  const vk::DeviceSize size = roundUp(bytes, gpu.traits.sharedMemoryAlignment);
  void* place = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (place == MAP_FAILED) throw vk::OutOfHostMemoryError("no memory for devices to share");
  const auto unmap = [size](std::byte* mapped) { munmap(mapped, size); };
  host = {std::shared_ptr<std::byte>(static_cast<std::byte*>(place), unmap), size};
}

// `host`: null: the device's own memory; else the process's, made where it points to nothing yet.
vk::raii::DeviceMemory memoryFor(const GpuDevice& gpu, const vk::MemoryRequirements& needs, MemoryUse use,
                                 HostMemory* host) {
  if (host == nullptr)
    return {gpu.device, vk::MemoryAllocateInfo(needs.size, findMemoryType(gpu, needs.memoryTypeBits, use))};
  provide(gpu, needs.size, *host);
  const auto type = gpu.device.getMemoryHostPointerPropertiesEXT(kHostAllocation, host->place.get()).memoryTypeBits;
  const vk::ImportMemoryHostPointerInfoEXT import(kHostAllocation, host->place.get());
  return {gpu.device,
          vk::MemoryAllocateInfo(roundUp(needs.size, gpu.traits.sharedMemoryAlignment),
                                 findMemoryType(gpu, needs.memoryTypeBits & type, MemoryUse::device), &import)};
}

GpuBuffer makeBuffer(const GpuDevice& gpu, vk::DeviceSize size, vk::BufferUsageFlags usage, MemoryUse use,
                     HostMemory* host) {
  GpuBuffer made;
  made.size = size;
  const vk::ExternalMemoryBufferCreateInfo external(kHostAllocation);
  const vk::BufferCreateInfo info({}, size, usage, vk::SharingMode::eExclusive, {},
                                  host != nullptr ? &external : nullptr);
  made.buffer = vk::raii::Buffer(gpu.device, info);
  made.memory = memoryFor(gpu, made.buffer.getMemoryRequirements(), use, host);
  made.buffer.bindMemory(*made.memory, 0);
  if (host != nullptr) made.host = *host;
  if (use == MemoryUse::device) return made;
  made.mapped = host != nullptr ? host->place.get() : static_cast<std::byte*>(made.memory.mapMemory(0, VK_WHOLE_SIZE));
  return made;
}

GpuImage makeImage(const GpuDevice& gpu, const ImageSpec& spec, HostMemory* host) {
  GpuImage made;
  made.spec = spec;
  const vk::ExternalMemoryImageCreateInfo external(kHostAllocation);
  vk::ImageCreateInfo info;
  info.setImageType(vk::ImageType::e2D).setFormat(spec.format).setUsage(spec.usage);
  info.setExtent({static_cast<uint32_t>(spec.widthPx), static_cast<uint32_t>(spec.heightPx), 1});
  info.setMipLevels(spec.mipLevels).setArrayLayers(spec.layers).setSamples(spec.samples);
  if (host != nullptr) info.setPNext(&external);
  made.image = vk::raii::Image(gpu.device, info);
  const vk::MemoryRequirements needs = made.image.getMemoryRequirements();
  made.bytes = needs.size;
  made.memory = memoryFor(gpu, needs, MemoryUse::device, host);
  if (host != nullptr) made.host = *host;
  made.image.bindMemory(*made.memory, 0);
  const vk::ImageSubresourceRange all(spec.aspect, 0, spec.mipLevels, 0, spec.layers);
  const auto type = spec.array ? vk::ImageViewType::e2DArray : vk::ImageViewType::e2D;
  made.view = vk::raii::ImageView(gpu.device, vk::ImageViewCreateInfo({}, *made.image, type, spec.format, {}, all));
  return made;
}

// make(device, memory to share or null) for each.
template <class Make>
auto onEach(GpuDevices gpus, Make&& make) {
  HostMemory host;
  std::vector<decltype(make(*gpus.front(), nullptr))> made;
  for (const auto& gpu : gpus) made.push_back(make(*gpu, gpus.size() > 1 ? &host : nullptr));
  return made;
}

}  // namespace

GpuBuffer createBuffer(const GpuDevice& gpu, vk::DeviceSize size, vk::BufferUsageFlags usage, MemoryUse use) {
  return makeBuffer(gpu, size, usage, use, nullptr);
}

std::vector<GpuBuffer> createBuffers(GpuDevices gpus, vk::DeviceSize size, vk::BufferUsageFlags usage, MemoryUse use) {
  return onEach(gpus, [&](const GpuDevice& gpu, HostMemory* host) { return makeBuffer(gpu, size, usage, use, host); });
}

GpuImage createImage(const GpuDevice& gpu, const ImageSpec& spec) {
  return makeImage(gpu, spec, nullptr);
}

std::vector<GpuImage> createImages(GpuDevices gpus, const ImageSpec& spec) {
  return onEach(gpus, [&](const GpuDevice& gpu, HostMemory* host) { return makeImage(gpu, spec, host); });
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
