#include "gpu/device_traits.h"

#include <fmt/format.h>

#include <algorithm>

namespace eye {
namespace {

// Ground seen at 7 degrees needs 8; beyond it lies a strip below the horizon, in haze.
constexpr float kAnisotropy = 8;

template <class Features>
struct Needed {
  vk::Bool32 Features::*feature;
  const char* name;
};
using Core = vk::PhysicalDeviceFeatures;
using V12 = vk::PhysicalDeviceVulkan12Features;
using V13 = vk::PhysicalDeviceVulkan13Features;

// What the renderer is written against. Descriptor indexing is not here: one array has all textures, and Mesa 22.3's
// lavapipe has none.
constexpr Needed<Core> kNeededCore[]{{&Core::multiDrawIndirect, "multiDrawIndirect"},
                                     {&Core::drawIndirectFirstInstance, "drawIndirectFirstInstance"}};
constexpr Needed<V12> kNeeded12[]{{&V12::scalarBlockLayout, "scalarBlockLayout"}};
constexpr Needed<V13> kNeeded13[]{{&V13::synchronization2, "synchronization2"},
                                  {&V13::dynamicRendering, "dynamicRendering"},
                                  {&V13::maintenance4, "maintenance4"}};

// Calls visit(vk::Bool32 of `features`, name) for each of them.
template <class Chain, class Visit>
void forEachNeeded(Chain& features, Visit&& visit) {
  for (const auto& needed : kNeededCore)
    visit(features.template get<vk::PhysicalDeviceFeatures2>().features.*needed.feature, needed.name);
  for (const auto& needed : kNeeded12) visit(features.template get<V12>().*needed.feature, needed.name);
  for (const auto& needed : kNeeded13) visit(features.template get<V13>().*needed.feature, needed.name);
}

// A family for graphics and, where a window is wanted, presentation.
std::optional<uint32_t> findQueueFamily(const DeviceFacts& facts) {
  for (uint32_t i = 0; i < facts.queueFamilies.size(); ++i) {
    constexpr vk::QueueFlags kNeeded = vk::QueueFlagBits::eGraphics | vk::QueueFlagBits::eCompute;
    if ((facts.queueFamilies[i].queueFlags & kNeeded) != kNeeded) continue;
    if (!facts.presents || (*facts.presents)[i]) return i;
  }
  return std::nullopt;
}

std::string whatLacks(const DeviceFacts& facts) {
  const uint32_t version = facts.properties.apiVersion;
  if (version < VK_API_VERSION_1_3)
    return fmt::format("Vulkan 1.3 (it has {}.{}.{})", VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version),
                       VK_API_VERSION_PATCH(version));
  std::string lacks;
  const auto need = [&lacks](bool has, const char* name) {
    if (!has) lacks += (lacks.empty() ? "" : ", ") + std::string(name);
  };
  forEachNeeded(facts.features, need);
  need(bool(facts.depthFormat & vk::FormatFeatureFlagBits::eDepthStencilAttachment), "a 32-bit float depth format");
  need(findQueueFamily(facts).has_value(),
       facts.presents ? "a queue that draws, computes and presents" : "a queue that draws and computes");
  return lacks;
}

}  // namespace

DeviceTraits chooseTraits(const DeviceFacts& facts) {
  const vk::PhysicalDeviceLimits& limits = facts.properties.limits;
  DeviceTraits traits;
  traits.lacks = whatLacks(facts);
  if (const auto family = findQueueFamily(facts)) {
    traits.queueFamily = *family;
    traits.timestampBits = facts.queueFamilies[*family].timestampValidBits;
  }
  traits.msPerTick = double(limits.timestampPeriod) * 1e-6;

  traits.isCpu = facts.properties.deviceType == vk::PhysicalDeviceType::eCpu;
  traits.cullsOnHost = traits.binsBeforeRastering = traits.isCpu;
  traits.blendsMipLevels = !traits.isCpu;
  if (facts.driver == vk::DriverId::eMesaLlvmpipe) traits.sharedMemoryAlignment = facts.hostMemoryAlignment;
  if (facts.features.get<vk::PhysicalDeviceFeatures2>().features.samplerAnisotropy)
    traits.mostAnisotropy = std::min(kAnisotropy, limits.maxSamplerAnisotropy);
  traits.drawsAnisotropic = !traits.isCpu && traits.mostAnisotropy > 1;

  traits.sampleCounts =
      limits.framebufferColorSampleCounts & limits.framebufferDepthSampleCounts & limits.sampledImageDepthSampleCounts;
  traits.mostTextureLayers = limits.maxImageArrayLayers;
  traits.mostDraws = limits.maxDrawIndirectCount;
  traits.mostWorkGroups = limits.maxComputeWorkGroupCount[0];
  traits.mostStorageBytes = limits.maxStorageBufferRange;
  return traits;
}

DeviceFeatures featuresToEnable(const DeviceTraits& traits) {
  DeviceFeatures features;
  forEachNeeded(features, [](vk::Bool32& feature, const char*) { feature = VK_TRUE; });
  features.get<vk::PhysicalDeviceFeatures2>().features.setSamplerAnisotropy(traits.mostAnisotropy > 1);
  return features;
}

std::string choicesText(const DeviceTraits& traits) {
  const char* imagery = traits.drawsAnisotropic ? "anisotropic" : traits.blendsMipLevels ? "trilinear" : "bilinear";
  return fmt::format("imagery {}, culling by {}, {}{} samples a pixel at most", imagery,
                     traits.cullsOnHost ? "the host" : "compute shaders",
                     traits.sharedMemoryAlignment > 0 ? "a band of the picture for each core, " : "",
                     traits.sampleCounts & vk::SampleCountFlagBits::e4 ? 4 : 1);
}

}  // namespace eye
