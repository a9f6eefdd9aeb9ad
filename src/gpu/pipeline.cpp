#include "gpu/pipeline.h"

#include "shared/config.h"

namespace eye {
namespace {

vk::raii::ShaderModule createModule(const GpuDevice& gpu, std::span<const uint32_t> spirv) {
  return {gpu.device, vk::ShaderModuleCreateInfo({}, spirv.size_bytes(), spirv.data())};
}

}  // namespace

vk::raii::Pipeline createPipeline(const GpuDevice& gpu, const vk::raii::PipelineCache& cache,
                                  const PipelineSpec& spec) {
  const vk::raii::ShaderModule vertex = createModule(gpu, spec.vertexSpirv);
  std::vector<vk::SpecializationMapEntry> entries;
  for (uint32_t id = 0; id < spec.vertexConstants.size(); ++id) entries.emplace_back(id, id * 4, 4);
  vk::SpecializationInfo constants;
  constants.setMapEntries(entries).setData<uint32_t>(spec.vertexConstants);
  std::vector<vk::PipelineShaderStageCreateInfo> stages;
  stages.push_back({{}, vk::ShaderStageFlagBits::eVertex, *vertex, "main", entries.empty() ? nullptr : &constants});
  vk::raii::ShaderModule fragment(nullptr);
  if (!spec.fragmentSpirv.empty()) {
    fragment = createModule(gpu, spec.fragmentSpirv);
    stages.push_back({{}, vk::ShaderStageFlagBits::eFragment, *fragment, "main"});
  }

  vk::PipelineVertexInputStateCreateInfo vertexInput;
  vertexInput.setVertexBindingDescriptions(spec.bindings).setVertexAttributeDescriptions(spec.attributes);
  const vk::PipelineInputAssemblyStateCreateInfo assembly(
      {}, spec.isStrip ? vk::PrimitiveTopology::eTriangleStrip : vk::PrimitiveTopology::eTriangleList);
  const vk::PipelineViewportStateCreateInfo viewport({}, 1, nullptr, 1, nullptr);
  vk::PipelineRasterizationStateCreateInfo raster;
  raster.setCullMode(spec.cull).setFrontFace(vk::FrontFace::eCounterClockwise).setLineWidth(1.0f);
  const vk::PipelineMultisampleStateCreateInfo samples({}, spec.samples);
  static_assert(EYE_REVERSED_Z == 1, "the comparisons below and the cleared depth belong together");
  const vk::PipelineDepthStencilStateCreateInfo depth(
      {}, spec.depth != DepthUse::none, spec.depth == DepthUse::testAndWrite,
      spec.depth == DepthUse::whereNothing ? vk::CompareOp::eEqual : vk::CompareOp::eGreater);
  vk::PipelineColorBlendAttachmentState target;
  target.setColorWriteMask(vk::ColorComponentFlagBits::eR | vk::ColorComponentFlagBits::eG |
                           vk::ColorComponentFlagBits::eB | vk::ColorComponentFlagBits::eA);
  const bool covers = spec.blend == Blend::alpha;
  target.setBlendEnable(spec.blend != Blend::none);
  target.setSrcColorBlendFactor(covers ? vk::BlendFactor::eSrcAlpha : vk::BlendFactor::eOne);
  target.setDstColorBlendFactor(covers ? vk::BlendFactor::eOneMinusSrcAlpha : vk::BlendFactor::eOne);
  target.setSrcAlphaBlendFactor(vk::BlendFactor::eZero).setDstAlphaBlendFactor(vk::BlendFactor::eOne);
  vk::PipelineColorBlendStateCreateInfo blend;
  const bool hasColour = spec.colourFormat != vk::Format::eUndefined;
  if (hasColour) blend.setAttachments(target);
  std::vector dynamicStates{vk::DynamicState::eViewport, vk::DynamicState::eScissor};
  if (spec.cull != vk::CullModeFlagBits::eNone) dynamicStates.push_back(vk::DynamicState::eFrontFace);
  vk::PipelineDynamicStateCreateInfo dynamic;
  dynamic.setDynamicStates(dynamicStates);
  vk::PipelineRenderingCreateInfo rendering;
  if (hasColour) rendering.setColorAttachmentFormats(spec.colourFormat);
  rendering.setDepthAttachmentFormat(spec.depthFormat);

  vk::GraphicsPipelineCreateInfo info;
  info.setStages(stages).setPVertexInputState(&vertexInput).setPInputAssemblyState(&assembly);
  info.setPViewportState(&viewport).setPRasterizationState(&raster).setPMultisampleState(&samples);
  info.setPDepthStencilState(&depth).setPColorBlendState(&blend).setPDynamicState(&dynamic);
  info.setLayout(spec.layout).setPNext(&rendering);
  return {gpu.device, cache, info};
}

vk::raii::Pipeline createComputePipeline(const GpuDevice& gpu, const vk::raii::PipelineCache& cache,
                                         std::span<const uint32_t> spirv, vk::PipelineLayout layout,
                                         std::optional<int32_t> constant) {
  const vk::raii::ShaderModule module = createModule(gpu, spirv);
  const vk::SpecializationMapEntry entry(0, 0, sizeof(int32_t));
  const int32_t value = constant.value_or(0);
  const vk::SpecializationInfo specialization(1, &entry, sizeof(value), &value);
  const vk::PipelineShaderStageCreateInfo stage({}, vk::ShaderStageFlagBits::eCompute, *module, "main",
                                                constant ? &specialization : nullptr);
  return {gpu.device, cache, vk::ComputePipelineCreateInfo(vk::PipelineCreateFlagBits::eDispatchBase, stage, layout)};
}

}  // namespace eye
