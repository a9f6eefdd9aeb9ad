// What depends on the device, chosen in one place: a function from what the device says of itself. All else asks the
// traits, and nothing asks for a vendor or a name. Pure, so that devices which are not here can be tested.
#pragma once

#include <optional>
#include <string>
#include <vector>
#include <vulkan/vulkan.hpp>

namespace eye {

using DeviceFeatures = vk::StructureChain<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan12Features,
                                          vk::PhysicalDeviceVulkan13Features>;

// What a device says of itself.
struct DeviceFacts {
  vk::PhysicalDeviceProperties properties;
  DeviceFeatures features;
  vk::FormatFeatureFlags depthFormat;  // D32 in optimal tiling
  std::vector<vk::QueueFamilyProperties> queueFamilies;
  std::optional<std::vector<bool>> presents;  // by family; nothing where no window is wanted
  uint64_t hostMemoryAlignment = 0;           // of VK_EXT_external_memory_host; 0: it is not there
  std::optional<vk::DriverId> driver;
};

struct DeviceTraits {
  std::string lacks;  // what makes it unusable, in words; the rest counts only where this is empty
  uint32_t queueFamily = 0;
  uint32_t timestampBits = 0;  // 0: the queue has no timestamps
  double msPerTick = 0;

  // A CPU: what it draws takes the time of the cores that also prepare frames.
  bool isCpu = false;
  bool cullsOnHost = false;          // plain code reduces depth maps and tests clusters faster than compute shaders
  bool binsBeforeRastering = false;  // draws of a pass wait for each other unless a time stamp parts them
  bool blendsMipLevels = true;       // by default: dear on a CPU
  // Memory of the process, so aligned, may be that of several such devices, which lay images out alike and keep to
  // blocks of pixels as render/bands.h has them: known of Mesa's alone. 0: it may not.
  uint64_t sharedMemoryAlignment = 0;
  float mostAnisotropy = 1;       // samples along a texel's footprint that --sampler anisotropic takes; 1: it cannot
  bool drawsAnisotropic = false;  // by default

  vk::SampleCountFlags sampleCounts;  // a pixel, of colour and of a depth that is read again
  uint32_t mostTextureLayers = 0, mostDraws = 0, mostWorkGroups = 0;
  uint64_t mostStorageBytes = 0;
};

DeviceTraits chooseTraits(const DeviceFacts& facts);
// To make a device with: what the renderer is written against, and what the traits choose beside it.
DeviceFeatures featuresToEnable(const DeviceTraits& traits);
// The choices in words, for --list-devices.
std::string choicesText(const DeviceTraits& traits);

}  // namespace eye
