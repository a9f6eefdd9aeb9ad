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
  // Waits, a tenth of a second at most, for an image that the display has done with; it is held until it is presented.
  // False where there is none: the window is minimised, covered or changing.
  bool acquire(const GpuDevice& gpu);
  // The image to show next, if acquire found one.
  std::optional<uint32_t> held() const { return isFree_ ? held_ : std::nullopt; }
  // `picture` is in usageCopySource and stays there.
  void recordCopy(const vk::raii::CommandBuffer& commands, const GpuImage& picture, uint32_t index) const;
  // Shows the image that is held. The commands that copied into it are complete.
  void present(const GpuDevice& gpu);

 private:
  std::optional<uint32_t> next(const GpuDevice& gpu);
  void recreate(const GpuDevice& gpu);

  const Window& window_;
  bool vsync_;
  bool stale_ = true;
  vk::raii::SurfaceKHR surface_{nullptr};
  vk::SurfaceFormatKHR format_;
  vk::Extent2D extent_;
  vk::raii::SwapchainKHR swapchain_{nullptr};
  std::vector<vk::Image> images_;
  vk::raii::Fence free_{nullptr};  // signals that the display has done with the image that is held
  std::optional<uint32_t> held_;
  bool isFree_ = false;  // what free_ has told
};

}  // namespace eye
