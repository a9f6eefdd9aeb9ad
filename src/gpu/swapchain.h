// The images of a window. A finished picture is copied into one, scaled where the window has just changed its size.
#pragma once

#include <optional>

#include "gpu/barrier.h"
#include "gpu/window.h"

namespace eye {

class Swapchain {
 public:
  // Throws vk::SystemError. `vsync`: FIFO, else MAILBOX or IMMEDIATE where the display offers them.
  Swapchain(const GpuDevice& gpu, const Window& window, bool vsync);

  // What pictures should have, so that a copy suffices.
  vk::Format format() const { return format_.format; }
  // An image to show next; nothing while the window is minimised or changing.
  std::optional<uint32_t> acquire(const GpuDevice& gpu);
  // `picture` is in usageCopySource and stays there.
  void recordCopy(const vk::raii::CommandBuffer& commands, const GpuImage& picture, uint32_t index) const;
  // Submits the commands that copy into the image, then shows it. `finished` signals when they are done.
  void submitAndPresent(const GpuDevice& gpu, vk::CommandBuffer commands, uint32_t index, vk::Fence finished);

 private:
  void recreate(const GpuDevice& gpu);

  const Window& window_;
  bool vsync_;
  bool stale_ = true;
  vk::raii::SurfaceKHR surface_{nullptr};
  vk::SurfaceFormatKHR format_;
  vk::Extent2D extent_;
  vk::raii::SwapchainKHR swapchain_{nullptr};
  std::vector<vk::Image> images_;
  vk::raii::Semaphore acquired_{nullptr};
  std::vector<vk::raii::Semaphore> drawn_;  // one an image: when a presentation is done with it, nobody tells
};

}  // namespace eye
