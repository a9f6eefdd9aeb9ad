#include "render/cull_pass.h"

#include <array>

#include "gpu/pipeline.h"
#include "shared/cull.h"
#include "spirv/cull_early_comp.h"
#include "spirv/cull_late_comp.h"
#include "spirv/depth_map_comp.h"
#include "spirv/depth_reduce_comp.h"

namespace eye {
namespace {

using Access = vk::AccessFlagBits2;
using Stage = vk::PipelineStageFlagBits2;

// From 800x600 to 320x240, the smallest of the selector's maps, a texel touches three pixels; in 1280x720 four or five.
constexpr int32_t kMostTaps = 5;

uint32_t groups(int count, int perGroup) {
  return static_cast<uint32_t>((count + perGroup - 1) / perGroup);
}

// From one dispatch to the next.
void recordComputeBarrier(const vk::raii::CommandBuffer& commands) {
  recordMemoryBarrier(commands, Stage::eComputeShader, Access::eShaderStorageWrite, Stage::eComputeShader,
                      Access::eShaderStorageRead | Access::eShaderStorageWrite);
}

// From a dispatch to the draws that take their commands from it.
void recordCommandsBarrier(const vk::raii::CommandBuffer& commands) {
  recordMemoryBarrier(commands, Stage::eComputeShader, Access::eShaderStorageWrite,
                      Stage::eDrawIndirect | Stage::eComputeShader,
                      Access::eIndirectCommandRead | Access::eShaderStorageRead | Access::eShaderStorageWrite);
}

}  // namespace

void recordDepthCopy(const vk::raii::CommandBuffer& commands, const Targets& targets, const GpuBuffer& to) {
  const std::array toCopy{imageBarrier(targets.depth, usageDepthTarget(), usageCopySource())};
  recordBarriers(commands, toCopy);
  const vk::Offset2D at = targets.area.offset;
  const auto width = static_cast<uint32_t>(targets.widthPx);
  vk::BufferImageCopy copy;
  copy.setBufferOffset(sizeof(float) * (static_cast<uint32_t>(at.y) * width + static_cast<uint32_t>(at.x)));
  copy.setBufferRowLength(width).setImageSubresource({vk::ImageAspectFlagBits::eDepth, 0, 0, 1});
  copy.setImageOffset({at.x, at.y, 0}).setImageExtent({targets.area.extent.width, targets.area.extent.height, 1});
  commands.copyImageToBuffer(*targets.depth.image, vk::ImageLayout::eTransferSrcOptimal, *to.buffer, copy);
  const std::array toTarget{imageBarrier(targets.depth, usageCopySource(), usageDepthTarget())};
  recordBarriers(commands, toTarget);
  recordMemoryBarrier(commands, Stage::eTransfer, Access::eTransferWrite, Stage::eComputeShader | Stage::eHost,
                      Access::eShaderStorageRead | Access::eHostRead);
}

CullPass::CullPass(const GpuDevice& gpu, const vk::raii::PipelineCache& cache) {
  std::vector<vk::DescriptorSetLayoutBinding> bindings;
  for (uint32_t binding = 0; binding < EYE_CULL_BINDINGS; ++binding)
    bindings.push_back({binding, vk::DescriptorType::eStorageBuffer, 1, vk::ShaderStageFlagBits::eCompute});
  setLayout_ = {gpu.device, vk::DescriptorSetLayoutCreateInfo({}, bindings)};
  const vk::DescriptorPoolSize size(vk::DescriptorType::eStorageBuffer, EYE_CULL_BINDINGS);
  pool_ = {gpu.device, vk::DescriptorPoolCreateInfo(vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet, 1, size)};
  set_ = std::move(vk::raii::DescriptorSets(gpu.device, vk::DescriptorSetAllocateInfo(*pool_, *setLayout_)).front());
  const vk::PushConstantRange push(vk::ShaderStageFlagBits::eCompute, 0, sizeof(shader::DepthLevel));
  layout_ = {gpu.device, vk::PipelineLayoutCreateInfo({}, *setLayout_, push)};
  const auto make = [&](std::span<const uint32_t> spirv) { return createComputePipeline(gpu, cache, spirv, *layout_); };
  early_ = make(k_cull_early_comp);
  late_ = make(k_cull_late_comp);
  for (int32_t taps = 0; taps <= kMostTaps; ++taps)
    map_.push_back(createComputePipeline(gpu, cache, k_depth_map_comp, *layout_, taps));
  reduce_ = make(k_depth_reduce_comp);
}

void CullPass::bind(const GpuDevice& gpu, const ChunkPools& pools, const CullLists& lists) {
  const std::array<const GpuBuffer*, EYE_CULL_BINDINGS> buffers{
      &lists.paramsBuffer(),  &lists.chunksBuffer(),  &lists.candidatesBuffer(), &pools.clusterBuffer(),
      &pools.visibleBuffer(), &lists.earlyBuffer(),   &lists.lateBuffer(),       &lists.fatesBuffer(),
      &lists.depthBuffer(),   &lists.pyramidBuffer(), &lists.pixelSpansBuffer()};
  std::array<vk::DescriptorBufferInfo, EYE_CULL_BINDINGS> infos;
  std::vector<vk::WriteDescriptorSet> writes;
  for (uint32_t binding = 0; binding < EYE_CULL_BINDINGS; ++binding) {
    infos[binding] = vk::DescriptorBufferInfo(*buffers[binding]->buffer, 0, VK_WHOLE_SIZE);
    writes.push_back({*set_, binding, 0, 1, vk::DescriptorType::eStorageBuffer, nullptr, &infos[binding]});
  }
  gpu.device.updateDescriptorSets(writes, nullptr);
}

void CullPass::dispatchClusters(const vk::raii::CommandBuffer& commands, const vk::raii::Pipeline& pipeline,
                                const CullLists& lists) const {
  commands.bindPipeline(vk::PipelineBindPoint::eCompute, *pipeline);
  commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *layout_, 0, *set_, nullptr);
  commands.dispatch(groups(static_cast<int>(lists.candidateCount()), EYE_CULL_GROUP), 1, 1);
}

void CullPass::recordWarmUp(const vk::raii::CommandBuffer& commands) const {
  commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *layout_, 0, *set_, nullptr);
  for (const vk::raii::Pipeline& map : map_) {
    commands.bindPipeline(vk::PipelineBindPoint::eCompute, *map);
    recordLevel(commands, {{1, 1}, {1, 1}, 0, 0});
    recordComputeBarrier(commands);
  }
}

void CullPass::recordEarly(const vk::raii::CommandBuffer& commands, const CullLists& lists) const {
  // Visibility: of the last frame's late pass, or cleared for chunks that have just come. The last frame's draws have
  // read the commands.
  recordMemoryBarrier(commands, Stage::eComputeShader | Stage::eTransfer | Stage::eDrawIndirect,
                      Access::eShaderStorageWrite | Access::eTransferWrite, Stage::eComputeShader,
                      Access::eShaderStorageRead | Access::eShaderStorageWrite);
  dispatchClusters(commands, early_, lists);
  recordCommandsBarrier(commands);
  // Of a frozen frame the CPU reads these fates.
  recordMemoryBarrier(commands, Stage::eComputeShader, Access::eShaderStorageWrite, Stage::eHost, Access::eHostRead);
}

void CullPass::recordLevel(const vk::raii::CommandBuffer& commands, const shader::DepthLevel& level) const {
  commands.pushConstants<shader::DepthLevel>(*layout_, vk::ShaderStageFlagBits::eCompute, 0, level);
  commands.dispatch(groups(level.size.x, EYE_DEPTH_GROUP), groups(level.size.y, EYE_DEPTH_GROUP), 1);
}

void CullPass::recordDepthPyramid(const vk::raii::CommandBuffer& commands, const CullLists& lists) const {
  commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *layout_, 0, *set_, nullptr);
  const int span = lists.longestSpanPx();
  commands.bindPipeline(vk::PipelineBindPoint::eCompute, *map_[static_cast<size_t>(span <= kMostTaps ? span : 0)]);
  const shader::CullParams& params = lists.params();
  shader::DepthLevel made{params.mapPx, params.picturePx, 0, 0};
  recordLevel(commands, made);
  commands.bindPipeline(vk::PipelineBindPoint::eCompute, *reduce_);
  for (int level = 1; level < params.levelCount; ++level) {
    recordComputeBarrier(commands);
    made = {shader::levelSize(params.mapPx, level), made.size, params.levelOffset[level], made.offset};
    recordLevel(commands, made);
  }
  recordComputeBarrier(commands);
}

void CullPass::recordLate(const vk::raii::CommandBuffer& commands, const CullLists& lists) const {
  dispatchClusters(commands, late_, lists);
  recordCommandsBarrier(commands);
  recordMemoryBarrier(commands, Stage::eComputeShader, Access::eShaderStorageWrite, Stage::eHost, Access::eHostRead);
}

}  // namespace eye
