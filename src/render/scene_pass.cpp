#include "render/scene_pass.h"

#include <algorithm>
#include <array>
#include <bit>

#include "gpu/pipeline.h"
#include "spirv/sky_frag.h"
#include "spirv/sky_vert.h"
#include "spirv/star_frag.h"
#include "spirv/star_vert.h"
#include "spirv/terrain_frag.h"
#include "spirv/terrain_tint_frag.h"
#include "spirv/terrain_tint_vert.h"
#include "spirv/terrain_vert.h"

namespace eye {
namespace {

using Type = vk::DescriptorType;
using Stage = vk::ShaderStageFlagBits;

vk::raii::DescriptorSetLayout createSetLayout(const GpuDevice& gpu) {
  const std::array bindings{
      vk::DescriptorSetLayoutBinding(EYE_BIND_FRAME, Type::eUniformBuffer, 1, Stage::eVertex | Stage::eFragment),
      vk::DescriptorSetLayoutBinding(EYE_BIND_TEXTURES, Type::eCombinedImageSampler, 1, Stage::eFragment)};
  return {gpu.device, vk::DescriptorSetLayoutCreateInfo({}, bindings)};
}

// Between mip levels a CPU device takes the nearest, which saves it 4 to 7 % of a frame; others blend.
vk::raii::Sampler createSampler(const GpuDevice& gpu) {
  const bool onCpu = gpu.properties.deviceType == vk::PhysicalDeviceType::eCpu;
  vk::SamplerCreateInfo info;
  info.setMagFilter(vk::Filter::eLinear).setMinFilter(vk::Filter::eLinear).setMaxLod(VK_LOD_CLAMP_NONE);
  info.setMipmapMode(onCpu ? vk::SamplerMipmapMode::eNearest : vk::SamplerMipmapMode::eLinear);
  info.setAddressModeU(vk::SamplerAddressMode::eClampToEdge).setAddressModeV(vk::SamplerAddressMode::eClampToEdge);
  return {gpu.device, info};
}

PipelineSpec terrainSpec() {
  using shader::DrawData;
  constexpr uint32_t kOutward = offsetof(DrawData, outwardEcef);
  PipelineSpec spec;
  spec.vertexSpirv = k_terrain_vert;
  spec.fragmentSpirv = k_terrain_frag;
  spec.bindings = {{0, sizeof(ChunkVertex), vk::VertexInputRate::eVertex},
                   {1, sizeof(DrawData), vk::VertexInputRate::eInstance}};
  spec.attributes = {{EYE_AT_POSITION_SKIRT, 0, vk::Format::eR16G16B16A16Sint, offsetof(ChunkVertex, x)},
                     {EYE_AT_PARAM, 0, vk::Format::eR16G16Unorm, offsetof(ChunkVertex, s)},
                     {EYE_AT_NORMAL, 0, vk::Format::eR16G16Snorm, offsetof(ChunkVertex, normalU)},
                     {EYE_AT_ORIGIN, 1, vk::Format::eR32G32B32Sint, offsetof(DrawData, originMinusEyeCell)},
                     {EYE_AT_STEP, 1, vk::Format::eR32Sfloat, offsetof(DrawData, stepM)},
                     {EYE_AT_FRACTION_SKIRT, 1, vk::Format::eR32G32B32A32Sfloat, offsetof(DrawData, eyeFractionM)},
                     {EYE_AT_UP, 1, vk::Format::eR32G32B32Sfloat, offsetof(DrawData, upEcef)},
                     {EYE_AT_LAYER, 1, vk::Format::eR32Uint, offsetof(DrawData, textureLayer)},
                     {EYE_AT_TEXTURE_MAP, 1, vk::Format::eR32G32B32A32Sfloat, offsetof(DrawData, textureScale)}};
  for (uint32_t side = 0; side < 4; ++side) {
    spec.attributes.push_back({EYE_AT_OUTWARD + side, 1, vk::Format::eR32G32B32Sfloat,
                               kOutward + side * static_cast<uint32_t>(sizeof(shader::vec4))});
  }
  spec.depth = DepthUse::testAndWrite;
  spec.cull = vk::CullModeFlagBits::eBack;
  return spec;
}

// As shaders/shared/bend.h numbers them.
std::vector<uint32_t> bendConstants(const SceneBend& bend) {
  std::vector<uint32_t> constants{VK_TRUE};
  for (const double value : {bend.stretchEast, bend.stretchNorth, bend.liftEastPerM, bend.liftNorthPerM})
    constants.push_back(std::bit_cast<uint32_t>(static_cast<float>(value)));
  return constants;
}

// The same records; the fourth numbers beside the skirts' directions are the tint.
PipelineSpec tintedSpec() {
  PipelineSpec spec = terrainSpec();
  spec.vertexSpirv = k_terrain_tint_vert;
  spec.fragmentSpirv = k_terrain_tint_frag;
  for (auto& attribute : spec.attributes)
    if (attribute.location >= EYE_AT_OUTWARD && attribute.location < EYE_AT_OUTWARD + 4)
      attribute.format = vk::Format::eR32G32B32A32Sfloat;
  spec.cull = vk::CullModeFlagBits::eNone;
  return spec;
}

PipelineSpec skySpec() {
  PipelineSpec spec;
  spec.vertexSpirv = k_sky_vert;
  spec.fragmentSpirv = k_sky_frag;
  spec.depth = DepthUse::whereNothing;
  return spec;
}

PipelineSpec starSpec() {
  PipelineSpec spec;
  spec.vertexSpirv = k_star_vert;
  spec.fragmentSpirv = k_star_frag;
  spec.bindings = {{0, sizeof(StarInstance), vk::VertexInputRate::eInstance}};
  spec.attributes = {{0, 0, vk::Format::eR32G32B32A32Sfloat, offsetof(StarInstance, ndc)},
                     {1, 0, vk::Format::eR32G32B32A32Sfloat, offsetof(StarInstance, direction_eye)}};
  spec.depth = DepthUse::whereNothing;
  spec.adds = true;
  return spec;
}

}  // namespace

ScenePass::ScenePass(const GpuDevice& gpu, const vk::raii::PipelineCache& cache, vk::Format colourFormat,
                     bool withTints, const std::optional<SceneBend>& bend) {
  frame_ = createBuffer(gpu, sizeof(shader::FrameData), vk::BufferUsageFlagBits::eUniformBuffer, MemoryUse::upload);
  starBuffer_ = createBuffer(gpu, stars().size() * sizeof(StarInstance), vk::BufferUsageFlagBits::eVertexBuffer,
                             MemoryUse::upload);
  sampler_ = createSampler(gpu);
  setLayout_ = createSetLayout(gpu);
  const std::array sizes{vk::DescriptorPoolSize(Type::eUniformBuffer, 1),
                         vk::DescriptorPoolSize(Type::eCombinedImageSampler, 1)};
  pool_ = vk::raii::DescriptorPool(
      gpu.device, vk::DescriptorPoolCreateInfo(vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet, 1, sizes));
  set_ = std::move(vk::raii::DescriptorSets(gpu.device, vk::DescriptorSetAllocateInfo(*pool_, *setLayout_)).front());
  layout_ = vk::raii::PipelineLayout(gpu.device, vk::PipelineLayoutCreateInfo({}, *setLayout_));
  const auto make = [&](PipelineSpec spec) {
    spec.layout = *layout_;
    spec.colourFormat = colourFormat;
    spec.depthFormat = kDepthFormat;
    return createPipeline(gpu, cache, spec);
  };
  PipelineSpec terrain = terrainSpec();
  if (bend) terrain.vertexConstants = bendConstants(*bend);
  terrain_ = make(std::move(terrain));
  if (withTints) tinted_ = make(tintedSpec());
  sky_ = make(skySpec());
  star_ = make(starSpec());
  const vk::DescriptorBufferInfo frame(*frame_.buffer, 0, VK_WHOLE_SIZE);
  gpu.device.updateDescriptorSets(vk::WriteDescriptorSet(*set_, EYE_BIND_FRAME, 0, Type::eUniformBuffer, {}, frame),
                                  nullptr);
}

void ScenePass::bindTextures(const GpuDevice& gpu, const GpuImage& textures) {
  const vk::DescriptorImageInfo info(*sampler_, *textures.view, vk::ImageLayout::eShaderReadOnlyOptimal);
  gpu.device.updateDescriptorSets(
      vk::WriteDescriptorSet(*set_, EYE_BIND_TEXTURES, 0, Type::eCombinedImageSampler, info), nullptr);
}

void ScenePass::placeStars(const FrameInput& input) {
  eye::placeStars(input, placedStars_);
  std::ranges::copy(placedStars_, starBuffer_.as<StarInstance>().begin());
}

void ScenePass::begin(const vk::raii::CommandBuffer& commands, const Targets& targets, Pass pass,
                      const std::optional<glm::vec3>& background) const {
  if (pass != Pass::first) {
    const std::array barriers{imageBarrier(targets.colour, usageColourTarget(), usageColourTarget()),
                              imageBarrier(targets.depth, usageDepthTarget(), usageDepthTarget())};
    recordBarriers(commands, barriers);
  } else {
    // The last frame may have copied from both.
    const Usage before = usageDiscarded(vk::PipelineStageFlagBits2::eTransfer);
    const std::array barriers{imageBarrier(targets.colour, before, usageColourTarget()),
                              imageBarrier(targets.depth, before, usageDepthTarget())};
    recordBarriers(commands, barriers);
  }
  using Load = vk::AttachmentLoadOp;
  const vk::Rect2D all({0, 0}, {static_cast<uint32_t>(targets.widthPx), static_cast<uint32_t>(targets.heightPx)});
  vk::RenderingAttachmentInfo colour, depth;
  colour.setImageView(*targets.colour.view).setImageLayout(vk::ImageLayout::eColorAttachmentOptimal);
  const bool goesOn = pass == Pass::goesOn;
  colour.setLoadOp(goesOn ? Load::eLoad : background ? Load::eClear : Load::eDontCare);
  if (background) colour.setClearValue(vk::ClearColorValue(background->r, background->g, background->b, 1.0f));
  depth.setImageView(*targets.depth.view).setImageLayout(vk::ImageLayout::eDepthAttachmentOptimal);
  depth.setLoadOp(goesOn ? Load::eLoad : Load::eClear);
  depth.setClearValue(vk::ClearDepthStencilValue(static_cast<float>(EYE_CLEAR_DEPTH), 0));
  vk::RenderingInfo info;
  info.setRenderArea(all).setLayerCount(1).setColorAttachments(colour).setPDepthAttachment(&depth);
  commands.beginRendering(info);
  commands.setViewport(
      0, vk::Viewport(0, 0, static_cast<float>(targets.widthPx), static_cast<float>(targets.heightPx), 0, 1));
  commands.setScissor(0, all);
  commands.setFrontFace(flips_ ? vk::FrontFace::eClockwise : vk::FrontFace::eCounterClockwise);
  commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, *layout_, 0, *set_, nullptr);
}

void ScenePass::drawTerrain(const vk::raii::CommandBuffer& commands, const GpuDevice& gpu, const ChunkPools& pools,
                            const GpuBuffer& draws, const GpuBuffer& indirect, uint32_t first, uint32_t count) const {
  drawWith(terrain_, commands, gpu, pools, draws, indirect, first, count);
}

void ScenePass::drawTinted(const vk::raii::CommandBuffer& commands, const GpuDevice& gpu, const ChunkPools& pools,
                           const GpuBuffer& draws, const GpuBuffer& indirect, uint32_t count) const {
  drawWith(tinted_, commands, gpu, pools, draws, indirect, 0, count);
}

void ScenePass::drawWith(const vk::raii::Pipeline& pipeline, const vk::raii::CommandBuffer& commands,
                         const GpuDevice& gpu, const ChunkPools& pools, const GpuBuffer& draws,
                         const GpuBuffer& indirect, uint32_t first, uint32_t count) const {
  commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *pipeline);
  commands.bindVertexBuffers(0, {pools.vertexBuffer(), *draws.buffer}, {0, 0});
  commands.bindIndexBuffer(pools.indexBuffer(), 0, vk::IndexType::eUint16);
  constexpr uint32_t kStride = sizeof(vk::DrawIndexedIndirectCommand);
  const uint32_t most = gpu.properties.limits.maxDrawIndirectCount;
  for (uint32_t done = 0; done < count; done += std::min(most, count - done)) {
    commands.drawIndexedIndirect(*indirect.buffer, vk::DeviceSize{first + done} * kStride, std::min(most, count - done),
                                 kStride);
  }
}

void ScenePass::drawSky(const vk::raii::CommandBuffer& commands) const {
  commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *sky_);
  commands.draw(3, 1, 0, 0);
  if (placedStars_.empty()) return;
  commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *star_);
  commands.bindVertexBuffers(0, *starBuffer_.buffer, {0});
  constexpr uint32_t kSpotVertices = 6;
  commands.draw(kSpotVertices, static_cast<uint32_t>(placedStars_.size()), 0, 0);
}

}  // namespace eye
