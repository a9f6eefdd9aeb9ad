// Barriers in one line each. Stages and accesses are named by what a resource was and will be used for.
#pragma once

#include <span>

#include "gpu/memory.h"

namespace eye {

struct Usage {
  vk::PipelineStageFlags2 stage;
  vk::AccessFlags2 access;
  vk::ImageLayout layout;
};

inline constexpr vk::PipelineStageFlags2 kDepthStages =
    vk::PipelineStageFlagBits2::eEarlyFragmentTests | vk::PipelineStageFlagBits2::eLateFragmentTests;

// The contents before are not wanted; what the frame before did with it is awaited all the same.
inline Usage usageDiscarded(vk::PipelineStageFlags2 lastUsedIn) {
  return {lastUsedIn, {}, vk::ImageLayout::eUndefined};
}
inline Usage usageColourTarget() {
  return {vk::PipelineStageFlagBits2::eColorAttachmentOutput,
          vk::AccessFlagBits2::eColorAttachmentRead | vk::AccessFlagBits2::eColorAttachmentWrite,
          vk::ImageLayout::eColorAttachmentOptimal};
}
inline Usage usageDepthTarget() {
  return {kDepthStages,
          vk::AccessFlagBits2::eDepthStencilAttachmentRead | vk::AccessFlagBits2::eDepthStencilAttachmentWrite,
          vk::ImageLayout::eDepthAttachmentOptimal};
}
inline Usage usageSampled() {
  return {vk::PipelineStageFlagBits2::eFragmentShader, vk::AccessFlagBits2::eShaderSampledRead,
          vk::ImageLayout::eShaderReadOnlyOptimal};
}
inline Usage usageCopySource() {
  return {vk::PipelineStageFlagBits2::eTransfer, vk::AccessFlagBits2::eTransferRead,
          vk::ImageLayout::eTransferSrcOptimal};
}
inline Usage usageCopyTarget() {
  return {vk::PipelineStageFlagBits2::eTransfer, vk::AccessFlagBits2::eTransferWrite,
          vk::ImageLayout::eTransferDstOptimal};
}

vk::ImageMemoryBarrier2 imageBarrier(vk::Image image, vk::ImageAspectFlags aspect, const Usage& from, const Usage& to);
vk::ImageMemoryBarrier2 imageBarrier(const GpuImage& image, const Usage& from, const Usage& to);
void recordBarriers(const vk::raii::CommandBuffer& commands, std::span<const vk::ImageMemoryBarrier2> images);
void recordMemoryBarrier(const vk::raii::CommandBuffer& commands, vk::PipelineStageFlags2 fromStage,
                         vk::AccessFlags2 fromAccess, vk::PipelineStageFlags2 toStage, vk::AccessFlags2 toAccess);

}  // namespace eye
