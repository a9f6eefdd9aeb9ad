// Commands that are recorded anew for each use, and the fence that tells when the device is done with them.
#pragma once

#include "gpu/device.h"

namespace eye {

class Submission {
 public:
  Submission() = default;  // unusable: for members that are made later
  explicit Submission(const GpuDevice& gpu);

  // Throw vk::SystemError where the device is lost. In this order, again and again.
  void begin() const { commands_.begin({vk::CommandBufferUsageFlagBits::eOneTimeSubmit}); }
  void submit(const GpuDevice& gpu) const;
  void wait(const GpuDevice& gpu) const;

  // To record into, between begin and submit.
  const vk::raii::CommandBuffer& commands() const { return commands_; }

 private:
  vk::raii::CommandBuffer commands_{nullptr};
  vk::raii::Fence finished_{nullptr};
};

}  // namespace eye
