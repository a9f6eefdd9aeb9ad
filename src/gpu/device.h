// The Vulkan instance, the device and its one queue. Owner thread: the one that created it.
// Everything in this folder throws vk::SystemError where Vulkan fails; the module `render` turns that into an Error.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

#include "base/error.h"
#include "gpu/device_description.h"
#include "gpu/device_traits.h"

namespace eye {

struct DeviceOptions {
  std::string name;       // part of a device's name, letter case ignored; empty: discrete before integrated before CPU
  bool validate = false;  // validation and synchronization validation; messages are logged and counted
  bool window = false;    // GLFW is initialised and the device must be able to present to its windows
  bool oneOfSeveral = false;  // which one thread gives their commands, one device after the other
};

// While it lives, Mesa's software rasteriser makes so many threads for each device, beside the one that takes its
// commands. It reads that from the environment, which no other thread may read meanwhile; what the user has set there
// stays.
class RasterThreads {
 public:
  explicit RasterThreads(int count);
  ~RasterThreads();
  RasterThreads(const RasterThreads&) = delete;
  RasterThreads& operator=(const RasterThreads&) = delete;

 private:
  bool isSet_;
};

struct GpuDevice {
  vk::raii::Context context;
  vk::raii::Instance instance{nullptr};
  vk::raii::DebugUtilsMessengerEXT messenger{nullptr};
  vk::raii::PhysicalDevice physical{nullptr};
  vk::raii::Device device{nullptr};
  vk::raii::Queue queue{nullptr};
  vk::raii::CommandPool commandPool{nullptr};
  vk::PhysicalDeviceProperties properties;  // who it is; what it can is in the traits
  DeviceTraits traits;
  vk::PhysicalDeviceMemoryProperties memory;
  DeviceDescription description;
  std::atomic<uint64_t> messages{0};  // of the validation layer
};

// Those that draw one picture together: one, or several of a CPU, all of one driver.
using GpuDevices = std::span<const std::unique_ptr<GpuDevice>>;

// notFound or unsupported with what to install, choose or set. Never throws.
Result<std::unique_ptr<GpuDevice>> createDevice(const DeviceOptions& options);
Result<std::vector<DeviceDescription>> listDevices();

// Records commands with `record(const vk::raii::CommandBuffer&)`, submits them and waits. For start-up and rare
// flushes.
template <class Record>
void runOnce(const GpuDevice& gpu, Record&& record) {
  vk::raii::CommandBuffers buffers(gpu.device, {*gpu.commandPool, vk::CommandBufferLevel::ePrimary, 1});
  const vk::raii::CommandBuffer& commands = buffers.front();
  commands.begin({vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
  record(commands);
  commands.end();
  const vk::CommandBufferSubmitInfo info(*commands);
  vk::SubmitInfo2 submit;
  submit.setCommandBufferInfos(info);
  const vk::raii::Fence fence(gpu.device, vk::FenceCreateInfo{});
  gpu.queue.submit2(submit, *fence);
  (void)gpu.device.waitForFences(*fence, true, UINT64_MAX);
}

}  // namespace eye
