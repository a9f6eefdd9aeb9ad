#include "gpu/swapchain.h"

#define GLFW_INCLUDE_NONE
#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>

#include <algorithm>

namespace eye {
namespace {

// A display that shows nothing of the window may give no image at all; keys and the closing of the window go on.
constexpr uint64_t kLongestWaitNs = 100'000'000;

vk::raii::SurfaceKHR createSurface(const GpuDevice& gpu, const Window& window) {
  VkSurfaceKHR surface = VK_NULL_HANDLE;
  const VkResult result = glfwCreateWindowSurface(*gpu.instance, window.handle(), nullptr, &surface);
  if (result != VK_SUCCESS) throw vk::InitializationFailedError("the window takes no Vulkan pictures");
  return {gpu.instance, surface};
}

// Eight bits a channel, as they are: the shaders compute colours as displayed.
vk::SurfaceFormatKHR chooseFormat(const std::vector<vk::SurfaceFormatKHR>& offered) {
  for (const vk::Format wanted : {vk::Format::eB8G8R8A8Unorm, vk::Format::eR8G8B8A8Unorm}) {
    for (const vk::SurfaceFormatKHR& format : offered) {
      if (format.format == wanted) return format;
    }
  }
  return offered.at(0);
}

vk::PresentModeKHR choosePresentMode(const std::vector<vk::PresentModeKHR>& offered, bool vsync) {
  if (vsync) return vk::PresentModeKHR::eFifo;
  for (const vk::PresentModeKHR wanted : {vk::PresentModeKHR::eMailbox, vk::PresentModeKHR::eImmediate}) {
    if (std::find(offered.begin(), offered.end(), wanted) != offered.end()) return wanted;
  }
  return vk::PresentModeKHR::eFifo;
}

}  // namespace

Swapchain::Swapchain(const GpuDevice& gpu, const Window& window, bool vsync)
    : window_(window), vsync_(vsync), surface_(createSurface(gpu, window)) {
  if (gpu.physical.getSurfaceSupportKHR(gpu.traits.queueFamily, *surface_) == VK_FALSE) {
    throw vk::InitializationFailedError("the device cannot show pictures in this window");
  }
  format_ = chooseFormat(gpu.physical.getSurfaceFormatsKHR(*surface_));
  free_ = vk::raii::Fence(gpu.device, vk::FenceCreateInfo{});
}

void Swapchain::recreate(const GpuDevice& gpu) {
  gpu.device.waitIdle();  // resize: presentations may still use the old images
  const vk::SurfaceCapabilitiesKHR can = gpu.physical.getSurfaceCapabilitiesKHR(*surface_);
  int widthPx = 0, heightPx = 0;
  window_.sizePx(widthPx, heightPx);
  extent_ = can.currentExtent;
  if (extent_.width == UINT32_MAX) {  // the window takes any size
    extent_.width = std::clamp(static_cast<uint32_t>(widthPx), can.minImageExtent.width, can.maxImageExtent.width);
    extent_.height = std::clamp(static_cast<uint32_t>(heightPx), can.minImageExtent.height, can.maxImageExtent.height);
  }
  if (extent_.width == 0 || extent_.height == 0 || widthPx == 0 || heightPx == 0) return;  // minimised
  const uint32_t most = can.maxImageCount == 0 ? UINT32_MAX : can.maxImageCount;
  vk::SwapchainCreateInfoKHR info;
  info.setSurface(*surface_).setMinImageCount(std::min(can.minImageCount + 1, most));
  info.setImageFormat(format_.format)
      .setImageColorSpace(format_.colorSpace)
      .setImageExtent(extent_)
      .setImageArrayLayers(1);
  info.setImageUsage(vk::ImageUsageFlagBits::eTransferDst).setPreTransform(can.currentTransform).setClipped(true);
  info.setPresentMode(choosePresentMode(gpu.physical.getSurfacePresentModesKHR(*surface_), vsync_));
  info.setOldSwapchain(*swapchain_);
  swapchain_ = vk::raii::SwapchainKHR(gpu.device, info);
  images_.clear();
  for (const VkImage image : swapchain_.getImages()) images_.emplace_back(image);
  stale_ = false;
}

bool Swapchain::acquire(const GpuDevice& gpu) {
  if (window_.minimised()) return false;
  if (!held_) {
    held_ = next(gpu);
    isFree_ = false;
  }
  if (!held_ || isFree_) return isFree_;
  if (gpu.device.waitForFences(*free_, true, kLongestWaitNs) == vk::Result::eTimeout) return false;
  gpu.device.resetFences(*free_);
  isFree_ = true;
  return true;
}

std::optional<uint32_t> Swapchain::next(const GpuDevice& gpu) {
  int widthPx = 0, heightPx = 0;
  window_.sizePx(widthPx, heightPx);  // not every display says that an image is out of date
  const vk::Extent2D size(static_cast<uint32_t>(widthPx), static_cast<uint32_t>(heightPx));
  if (size != extent_) stale_ = true;
  // Twice: the first try may find that the window has changed.
  for (int attempt = 0; attempt < 2; ++attempt) {
    if (stale_) recreate(gpu);
    if (stale_) return std::nullopt;
    try {
      const auto [result, index] = swapchain_.acquireNextImage(kLongestWaitNs, nullptr, *free_);
      if (result == vk::Result::eTimeout || result == vk::Result::eNotReady) return std::nullopt;
      if (result == vk::Result::eSuboptimalKHR) stale_ = true;  // still shown once more
      return index;
    } catch (const vk::OutOfDateKHRError&) {
      stale_ = true;
    }
  }
  return std::nullopt;
}

void Swapchain::recordCopy(const vk::raii::CommandBuffer& commands, const GpuImage& picture, uint32_t index) const {
  const vk::Image image = images_.at(index);
  const auto colour = vk::ImageAspectFlagBits::eColor;
  const std::array before{
      imageBarrier(image, colour, usageDiscarded(vk::PipelineStageFlagBits2::eNone), usageCopyTarget())};
  recordBarriers(commands, before);
  const auto from = vk::ImageLayout::eTransferSrcOptimal, to = vk::ImageLayout::eTransferDstOptimal;
  const vk::ImageSubresourceLayers layers(colour, 0, 0, 1);
  const vk::Extent3D size(static_cast<uint32_t>(picture.spec.widthPx), static_cast<uint32_t>(picture.spec.heightPx), 1);
  if (picture.spec.format == format_.format && size.width == extent_.width && size.height == extent_.height) {
    commands.copyImage(*picture.image, from, image, to, vk::ImageCopy(layers, {}, layers, {}, size));
  } else {
    const auto corner = [](uint32_t x, uint32_t y) {
      return vk::Offset3D(static_cast<int32_t>(x), static_cast<int32_t>(y), 1);
    };
    const std::array<vk::Offset3D, 2> all{vk::Offset3D(), corner(size.width, size.height)};
    const std::array<vk::Offset3D, 2> shown{vk::Offset3D(), corner(extent_.width, extent_.height)};
    commands.blitImage(*picture.image, from, image, to, vk::ImageBlit(layers, all, layers, shown), vk::Filter::eLinear);
  }
  const Usage present{vk::PipelineStageFlagBits2::eNone, {}, vk::ImageLayout::ePresentSrcKHR};
  const std::array after{imageBarrier(image, colour, usageCopyTarget(), present)};
  recordBarriers(commands, after);
}

void Swapchain::present(const GpuDevice& gpu) {
  const uint32_t index = held_.value();
  held_.reset();
  isFree_ = false;
  vk::PresentInfoKHR info;
  info.setSwapchains(*swapchain_).setImageIndices(index);
  try {
    if (gpu.queue.presentKHR(info) == vk::Result::eSuboptimalKHR) stale_ = true;
  } catch (const vk::OutOfDateKHRError&) {
    stale_ = true;
  }
}

}  // namespace eye
