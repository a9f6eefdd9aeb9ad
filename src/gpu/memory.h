// Buffers and images, each with an allocation of its own: the renderer has a dozen large ones, made at start, so a
// general allocator would have nothing to do. Throw vk::SystemError where the device has no memory left.
//
// Several devices may share one: each has a handle of its own for the same memory of this process, and what one has
// written the others read once its fence has been waited for.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "gpu/device.h"

namespace eye {

enum class MemoryUse {
  device,    // only the GPU touches it
  upload,    // the CPU writes, the GPU reads
  readBack,  // the GPU writes, the CPU reads: cached where there is such memory
};

// Of the process, imported by devices; null: the memory is one device's own.
struct HostMemory {
  std::shared_ptr<std::byte> place;
  vk::DeviceSize bytes = 0;
};

// What it was is given up first, each before what it stands on; assignment by members would go the other way.
template <class T>
T& replace(T& to, T&& from) {
  if (&to != &from) {
    std::destroy_at(&to);
    std::construct_at(&to, std::move(from));
  }
  return to;
}

struct GpuBuffer {
  HostMemory host;
  vk::raii::DeviceMemory memory{nullptr};  // behind what it is a part of: destroyed first, as is the next
  vk::raii::Buffer buffer{nullptr};
  vk::DeviceSize size = 0;
  std::byte* mapped = nullptr;  // whole buffer, coherent, for upload and readBack

  GpuBuffer() = default;
  GpuBuffer(GpuBuffer&&) noexcept = default;
  GpuBuffer& operator=(GpuBuffer&& from) noexcept { return replace(*this, std::move(from)); }

  template <class T>
  std::span<T> as() const {
    return {reinterpret_cast<T*>(mapped), size / sizeof(T)};
  }
};

GpuBuffer createBuffer(const GpuDevice& gpu, vk::DeviceSize size, vk::BufferUsageFlags usage, MemoryUse use);
// One that all devices see, in their order; with one device as createBuffer.
std::vector<GpuBuffer> createBuffers(GpuDevices gpus, vk::DeviceSize size, vk::BufferUsageFlags usage, MemoryUse use);

// Copies the first elements to the CPU and waits: for tests and debugging. `buffer` is a transfer source or mapped.
void readBytes(const GpuDevice& gpu, const GpuBuffer& buffer, std::span<std::byte> to);
template <class T>
std::vector<T> readBuffer(const GpuDevice& gpu, const GpuBuffer& buffer, size_t count) {
  std::vector<T> values(count);
  readBytes(gpu, buffer, std::as_writable_bytes(std::span<T>(values)));
  return values;
}

struct ImageSpec {
  int widthPx = 0, heightPx = 0;
  vk::Format format = vk::Format::eUndefined;
  vk::ImageUsageFlags usage;
  vk::ImageAspectFlags aspect = vk::ImageAspectFlagBits::eColor;
  uint32_t mipLevels = 1, layers = 1;
  vk::SampleCountFlagBits samples = vk::SampleCountFlagBits::e1;
  bool array = false;  // the view is an array, even of one layer
};

struct GpuImage {
  HostMemory host;
  vk::raii::DeviceMemory memory{nullptr};
  vk::raii::Image image{nullptr};
  vk::raii::ImageView view{nullptr};  // of everything
  ImageSpec spec;
  vk::DeviceSize bytes = 0;  // of its memory

  GpuImage() = default;
  GpuImage(GpuImage&&) noexcept = default;
  GpuImage& operator=(GpuImage&& from) noexcept { return replace(*this, std::move(from)); }
};

GpuImage createImage(const GpuDevice& gpu, const ImageSpec& spec);
std::vector<GpuImage> createImages(GpuDevices gpus, const ImageSpec& spec);

}  // namespace eye
