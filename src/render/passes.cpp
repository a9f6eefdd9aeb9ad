#include "render/passes.h"

#include "gpu/pipeline.h"
#include "spirv/attributes_frag.h"
#include "spirv/fullscreen_vert.h"
#include "spirv/shade_frag.h"
#include "spirv/terrain_vert.h"

namespace eye {
namespace {

using Type = vk::DescriptorType;
using Stage = vk::ShaderStageFlagBits;

vk::raii::DescriptorSetLayout createSetLayout(const GpuDevice& gpu) {
  const vk::ShaderStageFlags both = Stage::eVertex | Stage::eFragment;
  const std::array bindings{
      vk::DescriptorSetLayoutBinding(EYE_BIND_FRAME, Type::eUniformBuffer, 1, both),
      vk::DescriptorSetLayoutBinding(EYE_BIND_DRAWS, Type::eStorageBuffer, 1, Stage::eVertex),
      vk::DescriptorSetLayoutBinding(EYE_BIND_TEXEL_SIZES, Type::eStorageBuffer, 1, Stage::eFragment),
      vk::DescriptorSetLayoutBinding(EYE_BIND_TEXTURES, Type::eCombinedImageSampler, 1, Stage::eFragment),
      vk::DescriptorSetLayoutBinding(EYE_BIND_DEPTH, Type::eCombinedImageSampler, 1, Stage::eFragment),
      vk::DescriptorSetLayoutBinding(EYE_BIND_ATTRIBUTES, Type::eCombinedImageSampler, 1, Stage::eFragment)};
  return {gpu.device, vk::DescriptorSetLayoutCreateInfo({}, bindings)};
}

vk::raii::Sampler createSampler(const GpuDevice& gpu, vk::Filter filter, vk::SamplerMipmapMode mips) {
  vk::SamplerCreateInfo info;
  info.setMagFilter(filter).setMinFilter(filter).setMipmapMode(mips).setMaxLod(VK_LOD_CLAMP_NONE);
  info.setAddressModeU(vk::SamplerAddressMode::eClampToEdge).setAddressModeV(vk::SamplerAddressMode::eClampToEdge);
  return {gpu.device, info};
}

void writeBuffer(const GpuDevice& gpu, const vk::raii::DescriptorSet& set, uint32_t binding, Type type,
                 const GpuBuffer& buffer) {
  const vk::DescriptorBufferInfo info(*buffer.buffer, 0, VK_WHOLE_SIZE);
  gpu.device.updateDescriptorSets(vk::WriteDescriptorSet(*set, binding, 0, type, {}, info), nullptr);
}

void writeImage(const GpuDevice& gpu, const vk::raii::DescriptorSet& set, uint32_t binding,
                const vk::raii::Sampler& sampler, const GpuImage& image) {
  const vk::DescriptorImageInfo info(*sampler, *image.view, vk::ImageLayout::eShaderReadOnlyOptimal);
  gpu.device.updateDescriptorSets(vk::WriteDescriptorSet(*set, binding, 0, Type::eCombinedImageSampler, info), nullptr);
}

vk::Rect2D wholeOf(const Targets& targets) {
  return {{0, 0}, {static_cast<uint32_t>(targets.widthPx), static_cast<uint32_t>(targets.heightPx)}};
}

void setViewport(const vk::raii::CommandBuffer& commands, const Targets& targets) {
  commands.setViewport(
      0, vk::Viewport(0, 0, static_cast<float>(targets.widthPx), static_cast<float>(targets.heightPx), 0, 1));
  commands.setScissor(0, wholeOf(targets));
}

vk::raii::Pipeline createGeometryPipeline(const GpuDevice& gpu, const vk::raii::PipelineCache& cache,
                                          vk::PipelineLayout layout) {
  PipelineSpec spec;
  spec.vertexSpirv = k_terrain_vert;
  spec.fragmentSpirv = k_attributes_frag;
  spec.layout = layout;
  spec.bindings = {{0, sizeof(ChunkVertex), vk::VertexInputRate::eVertex}};
  spec.attributes = {{0, 0, vk::Format::eR16G16B16A16Sint, offsetof(ChunkVertex, x)},
                     {1, 0, vk::Format::eR16G16Unorm, offsetof(ChunkVertex, s)},
                     {2, 0, vk::Format::eR16G16Snorm, offsetof(ChunkVertex, normalU)}};
  spec.colourFormat = kAttributeFormat;
  spec.depthFormat = kDepthFormat;
  spec.cull = vk::CullModeFlagBits::eBack;
  return createPipeline(gpu, cache, spec);
}

vk::raii::Pipeline createShadePipeline(const GpuDevice& gpu, const vk::raii::PipelineCache& cache,
                                       vk::PipelineLayout layout, vk::Format colourFormat) {
  PipelineSpec spec;
  spec.vertexSpirv = k_fullscreen_vert;
  spec.fragmentSpirv = k_shade_frag;
  spec.layout = layout;
  spec.colourFormat = colourFormat;
  return createPipeline(gpu, cache, spec);
}

}  // namespace

Passes::Passes(const GpuDevice& gpu, const vk::raii::PipelineCache& cache, vk::Format colourFormat) {
  frame_ = createBuffer(gpu, sizeof(shader::FrameData), vk::BufferUsageFlagBits::eUniformBuffer, MemoryUse::upload);
  imagerySampler_ = createSampler(gpu, vk::Filter::eLinear, vk::SamplerMipmapMode::eLinear);
  fetchSampler_ = createSampler(gpu, vk::Filter::eNearest, vk::SamplerMipmapMode::eNearest);
  setLayout_ = createSetLayout(gpu);
  const std::array sizes{vk::DescriptorPoolSize(Type::eUniformBuffer, 1),
                         vk::DescriptorPoolSize(Type::eStorageBuffer, 2),
                         vk::DescriptorPoolSize(Type::eCombinedImageSampler, 3)};
  pool_ = vk::raii::DescriptorPool(
      gpu.device, vk::DescriptorPoolCreateInfo(vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet, 1, sizes));
  set_ = std::move(vk::raii::DescriptorSets(gpu.device, vk::DescriptorSetAllocateInfo(*pool_, *setLayout_)).front());
  layout_ = vk::raii::PipelineLayout(gpu.device, vk::PipelineLayoutCreateInfo({}, *setLayout_));
  geometry_ = createGeometryPipeline(gpu, cache, *layout_);
  shade_ = createShadePipeline(gpu, cache, *layout_, colourFormat);
  writeBuffer(gpu, set_, EYE_BIND_FRAME, Type::eUniformBuffer, frame_);
}

void Passes::bindTargets(const GpuDevice& gpu, const Targets& targets) {
  writeImage(gpu, set_, EYE_BIND_DEPTH, fetchSampler_, targets.depth);
  writeImage(gpu, set_, EYE_BIND_ATTRIBUTES, fetchSampler_, targets.attributes);
}

void Passes::bindDraws(const GpuDevice& gpu, const DrawLists& lists) {
  writeBuffer(gpu, set_, EYE_BIND_DRAWS, Type::eStorageBuffer, lists.draws());
  writeBuffer(gpu, set_, EYE_BIND_TEXEL_SIZES, Type::eStorageBuffer, lists.texelSizes());
}

void Passes::bindTextures(const GpuDevice& gpu, const GpuImage& textures) {
  writeImage(gpu, set_, EYE_BIND_TEXTURES, imagerySampler_, textures);
}

void Passes::recordGeometry(const vk::raii::CommandBuffer& commands, const GpuDevice& gpu, const Targets& targets,
                            const ChunkPools& pools, const DrawLists& lists, uint32_t commandCount) const {
  // The last frame read both: as textures, and the depth perhaps as a copy's source.
  const auto readers = vk::PipelineStageFlagBits2::eFragmentShader | vk::PipelineStageFlagBits2::eTransfer;
  const std::array before{imageBarrier(targets.attributes, usageDiscarded(readers), usageColourTarget()),
                          imageBarrier(targets.depth, usageDiscarded(readers), usageDepthTarget())};
  recordBarriers(commands, before);

  vk::RenderingAttachmentInfo attributes, depth;
  attributes.setImageView(*targets.attributes.view).setImageLayout(vk::ImageLayout::eColorAttachmentOptimal);
  attributes.setLoadOp(vk::AttachmentLoadOp::eDontCare).setStoreOp(vk::AttachmentStoreOp::eStore);
  depth.setImageView(*targets.depth.view).setImageLayout(vk::ImageLayout::eDepthAttachmentOptimal);
  depth.setLoadOp(vk::AttachmentLoadOp::eClear).setStoreOp(vk::AttachmentStoreOp::eStore);
  depth.setClearValue(vk::ClearDepthStencilValue(static_cast<float>(EYE_CLEAR_DEPTH), 0));
  vk::RenderingInfo info;
  info.setRenderArea(wholeOf(targets)).setLayerCount(1).setColorAttachments(attributes).setPDepthAttachment(&depth);
  commands.beginRendering(info);
  setViewport(commands, targets);
  commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *geometry_);
  commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, *layout_, 0, *set_, nullptr);
  commands.bindVertexBuffers(0, pools.vertexBuffer(), vk::DeviceSize{0});
  commands.bindIndexBuffer(pools.indexBuffer(), 0, vk::IndexType::eUint16);
  constexpr uint32_t kStride = sizeof(vk::DrawIndexedIndirectCommand);
  const uint32_t most = gpu.properties.limits.maxDrawIndirectCount;
  for (uint32_t first = 0; first < commandCount; first += std::min(most, commandCount - first)) {
    commands.drawIndexedIndirect(*lists.commands().buffer, vk::DeviceSize{first} * kStride,
                                 std::min(most, commandCount - first), kStride);
  }
  commands.endRendering();

  const std::array after{imageBarrier(targets.attributes, usageColourTarget(), usageSampled()),
                         imageBarrier(targets.depth, usageDepthTarget(), usageSampled())};
  recordBarriers(commands, after);
}

void Passes::recordShade(const vk::raii::CommandBuffer& commands, const Targets& targets) const {
  const std::array before{
      imageBarrier(targets.colour, usageDiscarded(vk::PipelineStageFlagBits2::eTransfer), usageColourTarget())};
  recordBarriers(commands, before);
  vk::RenderingAttachmentInfo colour;
  colour.setImageView(*targets.colour.view).setImageLayout(vk::ImageLayout::eColorAttachmentOptimal);
  colour.setLoadOp(vk::AttachmentLoadOp::eDontCare).setStoreOp(vk::AttachmentStoreOp::eStore);
  vk::RenderingInfo info;
  info.setRenderArea(wholeOf(targets)).setLayerCount(1).setColorAttachments(colour);
  commands.beginRendering(info);
  setViewport(commands, targets);
  commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *shade_);
  commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, *layout_, 0, *set_, nullptr);
  commands.draw(3, 1, 0, 0);
  commands.endRendering();
}

}  // namespace eye
