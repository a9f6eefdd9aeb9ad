// What is chosen for devices that are not here: facts in, traits out.
#include <catch2/catch.hpp>

#include "gpu/device_traits.h"

using namespace eye;

namespace {

using Queue = vk::QueueFlagBits;
using Core = vk::PhysicalDeviceFeatures2;

vk::QueueFamilyProperties family(vk::QueueFlags flags, uint32_t timestampBits) {
  vk::QueueFamilyProperties made;
  made.queueFlags = flags;
  made.queueCount = 1;
  made.timestampValidBits = timestampBits;
  return made;
}

// A graphics card with all that the renderer can use; its first family only copies.
DeviceFacts card() {
  DeviceFacts facts;
  facts.properties.apiVersion = VK_API_VERSION_1_3;
  facts.properties.deviceType = vk::PhysicalDeviceType::eDiscreteGpu;
  vk::PhysicalDeviceLimits& limits = facts.properties.limits;
  limits.maxSamplerAnisotropy = 16;
  limits.timestampPeriod = 40;
  limits.maxImageArrayLayers = 2048;
  limits.maxDrawIndirectCount = 1000;
  const vk::SampleCountFlags samples = vk::SampleCountFlagBits::e1 | vk::SampleCountFlagBits::e4;
  limits.framebufferColorSampleCounts = limits.framebufferDepthSampleCounts = samples;
  limits.sampledImageDepthSampleCounts = samples;
  facts.features.get<Core>().features.setMultiDrawIndirect(true).setDrawIndirectFirstInstance(true);
  facts.features.get<Core>().features.setSamplerAnisotropy(true).setGeometryShader(true);
  facts.features.get<vk::PhysicalDeviceVulkan12Features>().setScalarBlockLayout(true);
  facts.features.get<vk::PhysicalDeviceVulkan13Features>()
      .setSynchronization2(true)
      .setDynamicRendering(true)
      .setMaintenance4(true);
  facts.depthFormat = vk::FormatFeatureFlagBits::eDepthStencilAttachment;
  facts.queueFamilies = {family(Queue::eTransfer, 64), family(Queue::eGraphics | Queue::eCompute, 36)};
  return facts;
}

}  // namespace

TEST_CASE("a graphics card gets what it can: anisotropy, blended levels, its own culling") {
  const DeviceTraits traits = chooseTraits(card());
  CHECK(traits.lacks.empty());
  CHECK(traits.queueFamily == 1);
  CHECK(traits.timestampBits == 36);
  CHECK(traits.msPerTick == Approx(40e-6));
  CHECK_FALSE(traits.isCpu);
  CHECK_FALSE(traits.cullsOnHost);
  CHECK_FALSE(traits.binsBeforeRastering);
  CHECK(traits.blendsMipLevels);
  CHECK(traits.mostAnisotropy == 8);
  CHECK(traits.drawsAnisotropic);
  CHECK(bool(traits.sampleCounts & vk::SampleCountFlagBits::e4));
  CHECK(traits.mostTextureLayers == 2048);
  CHECK(traits.mostDraws == 1000);
  CHECK(choicesText(traits) == "imagery anisotropic, culling by compute shaders, 4 samples a pixel at most");
}

TEST_CASE("a card without anisotropy blends levels, and is asked for no more than it has") {
  DeviceFacts facts = card();
  facts.features.get<Core>().features.setSamplerAnisotropy(false);
  const DeviceTraits traits = chooseTraits(facts);
  CHECK(traits.mostAnisotropy == 1);
  CHECK_FALSE(traits.drawsAnisotropic);
  CHECK(traits.blendsMipLevels);
  CHECK_FALSE(featuresToEnable(traits).get<Core>().features.samplerAnisotropy);
  facts = card();
  facts.properties.limits.maxSamplerAnisotropy = 2;
  facts.properties.limits.framebufferDepthSampleCounts = vk::SampleCountFlagBits::e1;
  CHECK(chooseTraits(facts).mostAnisotropy == 2);
  CHECK_FALSE(bool(chooseTraits(facts).sampleCounts & vk::SampleCountFlagBits::e4));
}

TEST_CASE("a CPU gets what is cheap there, and can be told to take more") {
  DeviceFacts facts = card();
  facts.properties.deviceType = vk::PhysicalDeviceType::eCpu;
  const DeviceTraits traits = chooseTraits(facts);
  CHECK(traits.isCpu);
  CHECK(traits.cullsOnHost);
  CHECK(traits.binsBeforeRastering);
  CHECK_FALSE(traits.blendsMipLevels);
  CHECK_FALSE(traits.drawsAnisotropic);
  CHECK(traits.mostAnisotropy == 8);
  CHECK(choicesText(traits) == "imagery bilinear, culling by the host, 4 samples a pixel at most");
}

TEST_CASE("only what is needed is enabled") {
  const DeviceFeatures enabled = featuresToEnable(chooseTraits(card()));
  CHECK(enabled.get<Core>().features.multiDrawIndirect);
  CHECK(enabled.get<Core>().features.drawIndirectFirstInstance);
  CHECK(enabled.get<Core>().features.samplerAnisotropy);
  CHECK_FALSE(enabled.get<Core>().features.geometryShader);
  CHECK(enabled.get<vk::PhysicalDeviceVulkan12Features>().scalarBlockLayout);
  CHECK(enabled.get<vk::PhysicalDeviceVulkan13Features>().synchronization2);
  CHECK(enabled.get<vk::PhysicalDeviceVulkan13Features>().dynamicRendering);
  CHECK(enabled.get<vk::PhysicalDeviceVulkan13Features>().maintenance4);
}

TEST_CASE("memory is shared by devices whose way with pixels is known, where they can import it") {
  DeviceFacts facts = card();
  facts.hostMemoryAlignment = 4096;
  CHECK(chooseTraits(facts).sharedMemoryAlignment == 0);
  facts.driver = vk::DriverId::eGoogleSwiftshader;
  CHECK(chooseTraits(facts).sharedMemoryAlignment == 0);
  facts.driver = vk::DriverId::eMesaLlvmpipe;
  CHECK(chooseTraits(facts).sharedMemoryAlignment == 4096);
  CHECK(choicesText(chooseTraits(facts)).find("a band of the picture for each core") != std::string::npos);
  facts.hostMemoryAlignment = 0;
  CHECK(chooseTraits(facts).sharedMemoryAlignment == 0);
}

TEST_CASE("what a device lacks is named") {
  DeviceFacts facts = card();
  facts.features.get<Core>().features.setMultiDrawIndirect(false);
  facts.features.get<vk::PhysicalDeviceVulkan13Features>().setMaintenance4(false);
  facts.depthFormat = {};
  CHECK(chooseTraits(facts).lacks == "multiDrawIndirect, maintenance4, a 32-bit float depth format");

  facts = card();
  facts.properties.apiVersion = VK_MAKE_API_VERSION(0, 1, 2, 131);
  CHECK(chooseTraits(facts).lacks == "Vulkan 1.3 (it has 1.2.131)");

  facts = card();
  facts.queueFamilies.pop_back();
  CHECK(chooseTraits(facts).lacks == "a queue that draws and computes");
}

TEST_CASE("a queue that draws and cannot compute is passed over") {
  DeviceFacts facts = card();
  facts.queueFamilies.insert(facts.queueFamilies.begin(), family(Queue::eGraphics, 36));
  CHECK(chooseTraits(facts).queueFamily == 2);
}

TEST_CASE("the queue that presents is taken where there is a window") {
  DeviceFacts facts = card();
  facts.queueFamilies.push_back(family(Queue::eGraphics | Queue::eCompute, 0));
  facts.presents = std::vector{true, false, true};
  CHECK(chooseTraits(facts).queueFamily == 2);
  CHECK(chooseTraits(facts).timestampBits == 0);
  facts.presents = std::vector{true, false, false};
  CHECK(chooseTraits(facts).lacks == "a queue that draws, computes and presents");
}
