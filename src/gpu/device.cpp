#include "gpu/device.h"

#define GLFW_INCLUDE_NONE
#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <cstring>

#include "gpu/time_slices.h"

namespace eye {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";
constexpr const char* kRasterThreads = "LP_NUM_THREADS";
constexpr const char* kNoDriver =
    "no Vulkan driver was found: install a driver for the graphics card, or mesa-vulkan-drivers for rendering on the "
    "CPU "
    "(VK_ICD_FILENAMES must name an existing file where it is set)";

std::string versionText(uint32_t version) {
  return fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version),
                     VK_API_VERSION_PATCH(version));
}

std::string lowerCase(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                         VkDebugUtilsMessageTypeFlagsEXT,
                                         const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
  static_cast<std::atomic<uint64_t>*>(user)->fetch_add(1);
  if (severity >= VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT) {
    spdlog::error("vulkan: {}", data->pMessage);
  } else {
    spdlog::warn("vulkan: {}", data->pMessage);
  }
  return VK_FALSE;
}

// Throws vk::SystemError; an Error where something that is asked for is not installed.
Result<void> createInstance(const DeviceOptions& options, GpuDevice& gpu) {
  if (gpu.context.enumerateInstanceVersion() < VK_API_VERSION_1_3) {
    return fail(ErrorKind::unsupported, "the Vulkan loader is older than 1.3: install a newer libvulkan1");
  }
  std::vector<const char*> layers, extensions;
  if (options.validate) {
    const auto available = gpu.context.enumerateInstanceLayerProperties();
    const bool found = std::any_of(available.begin(), available.end(), [](const vk::LayerProperties& layer) {
      return std::strcmp(layer.layerName, kValidationLayer) == 0;
    });
    if (!found) {
      return fail(ErrorKind::notFound,
                  fmt::format("{} is not installed: install vulkan-validationlayers or leave out --validate",
                              kValidationLayer));
    }
    layers.push_back(kValidationLayer);
    extensions = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME};
  }
  if (options.window) {
    uint32_t count = 0;
    const char** names = glfwGetRequiredInstanceExtensions(&count);
    if (names == nullptr) {
      return fail(ErrorKind::unsupported,
                  "this display cannot show Vulkan pictures: run with --headless, or install the "
                  "Vulkan driver of the graphics card");
    }
    extensions.insert(extensions.end(), names, names + count);
  }
  const vk::ApplicationInfo application("eyepoint", 1, "eyepoint", 1, VK_API_VERSION_1_3);
  const auto severity =
      vk::DebugUtilsMessageSeverityFlagBitsEXT::eWarning | vk::DebugUtilsMessageSeverityFlagBitsEXT::eError;
  const auto types = vk::DebugUtilsMessageTypeFlagBitsEXT::eGeneral | vk::DebugUtilsMessageTypeFlagBitsEXT::eValidation;
  const vk::DebugUtilsMessengerCreateInfoEXT messenger({}, severity, types, &onMessage, &gpu.messages);
  const std::array extra{vk::ValidationFeatureEnableEXT::eSynchronizationValidation};
  vk::ValidationFeaturesEXT validation;
  validation.setEnabledValidationFeatures(extra);
  vk::InstanceCreateInfo info;
  info.setPApplicationInfo(&application).setPEnabledLayerNames(layers).setPEnabledExtensionNames(extensions);
  if (options.validate) info.setPNext(&validation);
  gpu.instance = vk::raii::Instance(gpu.context, info);
  if (options.validate) gpu.messenger = vk::raii::DebugUtilsMessengerEXT(gpu.instance, messenger);
  return {};
}

bool hasExtension(const vk::raii::PhysicalDevice& device, const char* name) {
  const auto extensions = device.enumerateDeviceExtensionProperties();
  return std::ranges::any_of(extensions, [name](const vk::ExtensionProperties& extension) {
    return std::strcmp(extension.extensionName, name) == 0;
  });
}

DeviceFacts factsOf(const vk::raii::Instance& instance, const vk::raii::PhysicalDevice& device, bool present) {
  DeviceFacts facts;
  facts.properties = device.getProperties();
  // Older ones do not know the structures that are asked.
  if (facts.properties.apiVersion >= VK_API_VERSION_1_3) {
    const DeviceFeatures has = device.getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan12Features,
                                                   vk::PhysicalDeviceVulkan13Features>();
    facts.features = has;
    const auto chain = device.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceVulkan12Properties>();
    facts.driver = chain.get<vk::PhysicalDeviceVulkan12Properties>().driverID;
  }
  facts.depthFormat = device.getFormatProperties(vk::Format::eD32Sfloat).optimalTilingFeatures;
  facts.queueFamilies = device.getQueueFamilyProperties();
  if (hasExtension(device, VK_EXT_EXTERNAL_MEMORY_HOST_EXTENSION_NAME)) {
    const auto chain =
        device.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceExternalMemoryHostPropertiesEXT>();
    facts.hostMemoryAlignment =
        chain.get<vk::PhysicalDeviceExternalMemoryHostPropertiesEXT>().minImportedHostPointerAlignment;
  }
  if (!present) return facts;
  facts.presents.emplace();
  for (uint32_t i = 0; i < facts.queueFamilies.size(); ++i)
    facts.presents->push_back(glfwGetPhysicalDevicePresentationSupport(*instance, *device, i) == GLFW_TRUE);
  return facts;
}

DeviceDescription describe(const vk::raii::PhysicalDevice& device, const vk::PhysicalDeviceProperties& properties,
                           const DeviceTraits& traits) {
  DeviceDescription description;
  description.name = properties.deviceName.data();
  switch (properties.deviceType) {
    case vk::PhysicalDeviceType::eDiscreteGpu:
      description.type = "discrete GPU";
      break;
    case vk::PhysicalDeviceType::eIntegratedGpu:
      description.type = "integrated GPU";
      break;
    case vk::PhysicalDeviceType::eVirtualGpu:
      description.type = "virtual GPU";
      break;
    case vk::PhysicalDeviceType::eCpu:
      description.type = "CPU";
      break;
    default:
      description.type = "other";
      break;
  }
  description.apiVersion = versionText(properties.apiVersion);
  description.driver = versionText(properties.driverVersion);
  if (properties.apiVersion >= VK_API_VERSION_1_2) {
    const auto chain = device.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceDriverProperties>();
    const auto& driver = chain.get<vk::PhysicalDeviceDriverProperties>();
    description.driver = fmt::format("{} {}", driver.driverName.data(), driver.driverInfo.data());
  }
  description.lacks = traits.lacks;
  description.usable = traits.lacks.empty();
  if (description.usable) description.choices = choicesText(traits);
  return description;
}

int rank(vk::PhysicalDeviceType type) {
  switch (type) {
    case vk::PhysicalDeviceType::eDiscreteGpu:
      return 4;
    case vk::PhysicalDeviceType::eIntegratedGpu:
      return 3;
    case vk::PhysicalDeviceType::eVirtualGpu:
      return 2;
    case vk::PhysicalDeviceType::eCpu:
      return 1;
    default:
      return 0;
  }
}

Result<void> choosePhysicalDevice(const DeviceOptions& options, GpuDevice& gpu) {
  int best = -1;
  std::string seen;
  for (vk::raii::PhysicalDevice& device : vk::raii::PhysicalDevices(gpu.instance)) {
    const DeviceFacts facts = factsOf(gpu.instance, device, options.window);
    DeviceTraits traits = chooseTraits(facts);
    DeviceDescription description = describe(device, facts.properties, traits);
    seen += fmt::format("{}'{}'{}", seen.empty() ? "" : ", ", description.name,
                        description.usable ? "" : " (lacks " + description.lacks + ")");
    const bool named = lowerCase(description.name).find(lowerCase(options.name)) != std::string::npos;
    const int score = rank(facts.properties.deviceType);
    if (!named || !description.usable || score <= best) continue;
    best = score;
    gpu.physical = std::move(device);
    gpu.properties = facts.properties;
    gpu.traits = std::move(traits);
    gpu.description = std::move(description);
  }
  if (seen.empty()) return fail(ErrorKind::notFound, kNoDriver);
  if (best >= 0) return {};
  if (options.name.empty()) return fail(ErrorKind::unsupported, "no Vulkan device can be used; there are: " + seen);
  return fail(
      ErrorKind::notFound,
      fmt::format("no usable Vulkan device is called '{}'; --device takes a part of one of: {}", options.name, seen));
}

void createLogicalDevice(const DeviceOptions& options, GpuDevice& gpu) {
  gpu.memory = gpu.physical.getMemoryProperties();
  const float priority = 1.0f;
  const vk::DeviceQueueCreateInfo queue({}, gpu.traits.queueFamily, 1, &priority);
  std::vector<const char*> extensions;
  if (options.window) extensions.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
  if (gpu.traits.sharedMemoryAlignment > 0) extensions.push_back(VK_EXT_EXTERNAL_MEMORY_HOST_EXTENSION_NAME);
  const DeviceFeatures features = featuresToEnable(gpu.traits);
  vk::DeviceCreateInfo info;
  info.setQueueCreateInfos(queue).setPEnabledExtensionNames(extensions);
  info.setPNext(&features.get<vk::PhysicalDeviceFeatures2>());
  {
    // Of several devices that are given work one after the other none is to wait for what the first does.
    std::optional<PatientThreads> patient;
    if (gpu.traits.isCpu && options.oneOfSeveral) patient.emplace();
    gpu.device = vk::raii::Device(gpu.physical, info);
  }
  gpu.queue = vk::raii::Queue(gpu.device, gpu.traits.queueFamily, 0);
  gpu.commandPool =
      vk::raii::CommandPool(gpu.device, {vk::CommandPoolCreateFlagBits::eResetCommandBuffer, gpu.traits.queueFamily});
}

}  // namespace

RasterThreads::RasterThreads(int count) : isSet_(std::getenv(kRasterThreads) == nullptr) {
  if (isSet_) setenv(kRasterThreads, std::to_string(count).c_str(), 1);
}

RasterThreads::~RasterThreads() {
  if (isSet_) unsetenv(kRasterThreads);
}

Result<std::unique_ptr<GpuDevice>> createDevice(const DeviceOptions& options) {
  try {
    auto gpu = std::make_unique<GpuDevice>();
    if (auto made = createInstance(options, *gpu); !made) return tl::unexpected(made.error());
    if (auto chosen = choosePhysicalDevice(options, *gpu); !chosen) return tl::unexpected(chosen.error());
    createLogicalDevice(options, *gpu);
    return gpu;
  } catch (const vk::IncompatibleDriverError&) {
    return fail(ErrorKind::notFound, kNoDriver);
  } catch (const std::exception& e) {
    return fail(ErrorKind::unsupported,
                fmt::format("Vulkan does not start ({}): check the graphics driver with vulkaninfo", e.what()));
  }
}

Result<std::vector<DeviceDescription>> listDevices() {
  try {
    GpuDevice gpu;
    if (auto made = createInstance({}, gpu); !made) return tl::unexpected(made.error());
    std::vector<DeviceDescription> all;
    for (const vk::raii::PhysicalDevice& device : vk::raii::PhysicalDevices(gpu.instance)) {
      const DeviceFacts facts = factsOf(gpu.instance, device, false);
      all.push_back(describe(device, facts.properties, chooseTraits(facts)));
    }
    if (all.empty()) return fail(ErrorKind::notFound, kNoDriver);
    return all;
  } catch (const vk::IncompatibleDriverError&) {
    return fail(ErrorKind::notFound, kNoDriver);
  } catch (const std::exception& e) {
    return fail(ErrorKind::unsupported,
                fmt::format("Vulkan does not start ({}): check the graphics driver with vulkaninfo", e.what()));
  }
}

}  // namespace eye
