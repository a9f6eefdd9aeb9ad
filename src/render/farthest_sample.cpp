#include "render/farthest_sample.h"

#include <array>

#include "gpu/pipeline.h"
#include "spirv/depth_farthest_comp.h"

namespace eye {
namespace {

using Access = vk::AccessFlagBits2;
using Stage = vk::PipelineStageFlagBits2;
using Type = vk::DescriptorType;

constexpr Usage kRead{Stage::eComputeShader, Access::eShaderSampledRead, vk::ImageLayout::eShaderReadOnlyOptimal};

uint32_t groups(uint32_t count) {
  return (count + EYE_DEPTH_GROUP - 1) / EYE_DEPTH_GROUP;
}

}  // namespace

FarthestSample::FarthestSample(const GpuDevice& gpu, const vk::raii::PipelineCache& cache) {
  sampler_ = {gpu.device, vk::SamplerCreateInfo{}};
  const std::array bindings{
      vk::DescriptorSetLayoutBinding(0, Type::eCombinedImageSampler, 1, vk::ShaderStageFlagBits::eCompute),
      vk::DescriptorSetLayoutBinding(1, Type::eStorageBuffer, 1, vk::ShaderStageFlagBits::eCompute)};
  setLayout_ = {gpu.device, vk::DescriptorSetLayoutCreateInfo({}, bindings)};
  const std::array sizes{vk::DescriptorPoolSize(Type::eCombinedImageSampler, 1),
                         vk::DescriptorPoolSize(Type::eStorageBuffer, 1)};
  pool_ = {gpu.device, vk::DescriptorPoolCreateInfo(vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet, 1, sizes)};
  set_ = std::move(vk::raii::DescriptorSets(gpu.device, vk::DescriptorSetAllocateInfo(*pool_, *setLayout_)).front());
  layout_ = {gpu.device, vk::PipelineLayoutCreateInfo({}, *setLayout_)};
  pipeline_ = createComputePipeline(gpu, cache, k_depth_farthest_comp, *layout_);
}

void FarthestSample::bind(const GpuDevice& gpu, const Targets& targets, const GpuBuffer& to) {
  const vk::DescriptorImageInfo image(*sampler_, *targets.depthSamples.view, kRead.layout);
  const vk::DescriptorBufferInfo buffer(*to.buffer, 0, VK_WHOLE_SIZE);
  const std::array writes{vk::WriteDescriptorSet(*set_, 0, 0, Type::eCombinedImageSampler, image),
                          vk::WriteDescriptorSet(*set_, 1, 0, 1, Type::eStorageBuffer, nullptr, &buffer)};
  gpu.device.updateDescriptorSets(writes, nullptr);
}

void FarthestSample::record(const vk::raii::CommandBuffer& commands, const Targets& targets) const {
  const std::array toRead{imageBarrier(targets.depthSamples, usageDepthTarget(), kRead)};
  recordBarriers(commands, toRead);
  commands.bindPipeline(vk::PipelineBindPoint::eCompute, *pipeline_);
  commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *layout_, 0, *set_, nullptr);
  const vk::Offset2D at = targets.area.offset;
  const vk::Extent2D extent = targets.area.extent;
  commands.dispatchBase(static_cast<uint32_t>(at.x) / EYE_DEPTH_GROUP, static_cast<uint32_t>(at.y) / EYE_DEPTH_GROUP, 0,
                        groups(extent.width), groups(extent.height), 1);
  const std::array toTarget{imageBarrier(targets.depthSamples, kRead, usageDepthTarget())};
  recordBarriers(commands, toTarget);
  recordMemoryBarrier(commands, Stage::eComputeShader, Access::eShaderStorageWrite,
                      Stage::eComputeShader | Stage::eHost, Access::eShaderStorageRead | Access::eHostRead);
}

}  // namespace eye
