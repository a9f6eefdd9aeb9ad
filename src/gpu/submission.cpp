#include "gpu/submission.h"

#include "telemetry/trace.h"

namespace eye {

Submission::Submission(const GpuDevice& gpu) {
  const vk::CommandBufferAllocateInfo one(*gpu.commandPool, vk::CommandBufferLevel::ePrimary, 1);
  commands_ = std::move(vk::raii::CommandBuffers(gpu.device, one).front());
  finished_ = vk::raii::Fence(gpu.device, vk::FenceCreateInfo{});
}

void Submission::submit(const GpuDevice& gpu) const {
  commands_.end();
  const vk::CommandBufferSubmitInfo info(*commands_);
  vk::SubmitInfo2 submit;
  submit.setCommandBufferInfos(info);
  gpu.queue.submit2(submit, *finished_);
}

void Submission::wait(const GpuDevice& gpu) const {
  const TraceScope scope("wait for the GPU");
  (void)gpu.device.waitForFences(*finished_, true, UINT64_MAX);
  gpu.device.resetFences(*finished_);
}

}  // namespace eye
