#include "gpu/barrier.h"

namespace eye {

vk::ImageMemoryBarrier2 imageBarrier(vk::Image image, vk::ImageAspectFlags aspect, const Usage& from, const Usage& to) {
  vk::ImageMemoryBarrier2 barrier;
  barrier.setSrcStageMask(from.stage).setSrcAccessMask(from.access).setOldLayout(from.layout);
  barrier.setDstStageMask(to.stage).setDstAccessMask(to.access).setNewLayout(to.layout);
  barrier.setSrcQueueFamilyIndex(VK_QUEUE_FAMILY_IGNORED).setDstQueueFamilyIndex(VK_QUEUE_FAMILY_IGNORED);
  barrier.setImage(image).setSubresourceRange({aspect, 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS});
  return barrier;
}

vk::ImageMemoryBarrier2 imageBarrier(const GpuImage& image, const Usage& from, const Usage& to) {
  return imageBarrier(*image.image, image.spec.aspect, from, to);
}

void recordBarriers(const vk::raii::CommandBuffer& commands, std::span<const vk::ImageMemoryBarrier2> images) {
  vk::DependencyInfo info;
  info.setImageMemoryBarrierCount(static_cast<uint32_t>(images.size())).setPImageMemoryBarriers(images.data());
  commands.pipelineBarrier2(info);
}

void recordMemoryBarrier(const vk::raii::CommandBuffer& commands, vk::PipelineStageFlags2 fromStage,
                         vk::AccessFlags2 fromAccess, vk::PipelineStageFlags2 toStage, vk::AccessFlags2 toAccess) {
  const vk::MemoryBarrier2 barrier(fromStage, fromAccess, toStage, toAccess);
  vk::DependencyInfo info;
  info.setMemoryBarriers(barrier);
  commands.pipelineBarrier2(info);
}

}  // namespace eye
