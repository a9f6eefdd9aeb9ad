#include "render/depth_view.h"

#include "gpu/pipeline.h"
#include "shared/cull.h"
#include "spirv/depth_view_frag.h"
#include "spirv/sky_vert.h"

namespace eye {
namespace {

constexpr float kFinestShare = 0.45f;  // of the picture's width; the coarser levels together take as much again
constexpr float kGapPx = 8;
constexpr float kLeastPx = 10;  // of a level's longer side

}  // namespace

DepthView::DepthView(const GpuDevice& gpu, const vk::raii::PipelineCache& cache, vk::Format colourFormat) {
  using Type = vk::DescriptorType;
  const vk::DescriptorSetLayoutBinding binding(0, Type::eStorageBuffer, 1, vk::ShaderStageFlagBits::eFragment);
  setLayout_ = {gpu.device, vk::DescriptorSetLayoutCreateInfo({}, binding)};
  const vk::DescriptorPoolSize size(Type::eStorageBuffer, 1);
  pool_ = {gpu.device, vk::DescriptorPoolCreateInfo(vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet, 1, size)};
  set_ = std::move(vk::raii::DescriptorSets(gpu.device, vk::DescriptorSetAllocateInfo(*pool_, *setLayout_)).front());
  const vk::PushConstantRange push(vk::ShaderStageFlagBits::eFragment, 0, sizeof(shader::DepthViewLevel));
  layout_ = {gpu.device, vk::PipelineLayoutCreateInfo({}, *setLayout_, push)};
  PipelineSpec spec;
  spec.vertexSpirv = k_sky_vert;
  spec.fragmentSpirv = k_depth_view_frag;
  spec.layout = *layout_;
  spec.colourFormat = colourFormat;
  pipeline_ = createPipeline(gpu, cache, spec);
}

void DepthView::bind(const GpuDevice& gpu, const CullLists& lists) {
  const vk::DescriptorBufferInfo info(*lists.pyramidBuffer().buffer, 0, VK_WHOLE_SIZE);
  gpu.device.updateDescriptorSets(
      vk::WriteDescriptorSet(*set_, 0, 0, 1, vk::DescriptorType::eStorageBuffer, nullptr, &info), nullptr);
}

void DepthView::record(const vk::raii::CommandBuffer& commands, const Targets& targets, const CullLists& lists) const {
  using Stage = vk::PipelineStageFlagBits2;
  recordMemoryBarrier(commands, Stage::eComputeShader, vk::AccessFlagBits2::eShaderStorageWrite, Stage::eFragmentShader,
                      vk::AccessFlagBits2::eShaderStorageRead);
  const std::array barriers{imageBarrier(targets.colour, usageColourTarget(), usageColourTarget())};
  recordBarriers(commands, barriers);
  vk::RenderingAttachmentInfo colour;
  colour.setImageView(*targets.colour.view).setImageLayout(vk::ImageLayout::eColorAttachmentOptimal);
  colour.setLoadOp(vk::AttachmentLoadOp::eLoad);
  vk::RenderingInfo info;
  info.setRenderArea({{0, 0}, {static_cast<uint32_t>(targets.widthPx), static_cast<uint32_t>(targets.heightPx)}});
  info.setLayerCount(1).setColorAttachments(colour);
  commands.beginRendering(info);
  commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *pipeline_);
  commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, *layout_, 0, *set_, nullptr);

  const shader::CullParams& params = lists.params();
  const auto width = static_cast<float>(targets.widthPx), height = static_cast<float>(targets.heightPx);
  float left = kGapPx, shownPx = kFinestShare * width;  // of the level's longer side
  for (int level = 0; level < params.levelCount; ++level) {
    const glm::ivec2 size = shader::levelSize(params.mapPx, level);
    const glm::vec2 texels(size);
    const float perTexelPx = std::max(shownPx, kLeastPx) / std::max(texels.x, texels.y);
    const glm::vec2 sizePx = glm::max(glm::floor(texels * perTexelPx), glm::vec2(1.0f));
    const glm::vec2 cornerPx(left, std::max(0.0f, height - kGapPx - sizePx.y));
    if (cornerPx.x + sizePx.x > width) break;
    commands.setViewport(0, vk::Viewport(0, 0, width, height, 0, 1));
    commands.setScissor(0, vk::Rect2D({static_cast<int32_t>(cornerPx.x), static_cast<int32_t>(cornerPx.y)},
                                      {static_cast<uint32_t>(sizePx.x), static_cast<uint32_t>(sizePx.y)}));
    const shader::DepthViewLevel shown{glm::floor(cornerPx), texels / sizePx, size, params.levelOffset[level],
                                       params.nearM};
    commands.pushConstants<shader::DepthViewLevel>(*layout_, vk::ShaderStageFlagBits::eFragment, 0, shown);
    commands.draw(3, 1, 0, 0);
    left += sizePx.x + kGapPx;
    shownPx /= 2;
  }
  commands.endRendering();
}

}  // namespace eye
