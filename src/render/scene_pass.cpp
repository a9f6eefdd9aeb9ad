#include "render/scene_pass.h"

#include <algorithm>
#include <array>
#include <bit>

#include "gpu/pipeline.h"
#include "paging/horizon.h"
#include "spirv/cloud_frag.h"
#include "spirv/cloud_vert.h"
#include "spirv/sky_dome_frag.h"
#include "spirv/sky_dome_vert.h"
#include "spirv/sky_frag.h"
#include "spirv/sky_vert.h"
#include "spirv/star_frag.h"
#include "spirv/star_vert.h"
#include "spirv/sun_frag.h"
#include "spirv/sun_vert.h"
#include "spirv/terrain_frag.h"
#include "spirv/terrain_tint_frag.h"
#include "spirv/terrain_tint_vert.h"
#include "spirv/terrain_vert.h"
#include "spirv/terrain_wide_frag.h"
#include "spirv/terrain_wide_vert.h"

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

vk::raii::Sampler createSampler(const GpuDevice& gpu, TextureFilter filter) {
  const vk::Filter within = filter == TextureFilter::nearest ? vk::Filter::eNearest : vk::Filter::eLinear;
  const bool blends = filter == TextureFilter::trilinear || filter == TextureFilter::anisotropic;
  vk::SamplerCreateInfo info;
  info.setMagFilter(within).setMinFilter(within).setMaxLod(VK_LOD_CLAMP_NONE);
  info.setMipmapMode(blends ? vk::SamplerMipmapMode::eLinear : vk::SamplerMipmapMode::eNearest);
  if (filter == TextureFilter::anisotropic) info.setAnisotropyEnable(true).setMaxAnisotropy(gpu.traits.mostAnisotropy);
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

PipelineSpec wideSpec() {
  PipelineSpec spec = terrainSpec();
  spec.vertexSpirv = k_terrain_wide_vert;
  spec.fragmentSpirv = k_terrain_wide_frag;
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

// Drawn where no terrain stands: the sky or, adding their light, sun and stars.
PipelineSpec backdropSpec(std::span<const uint32_t> vertexSpirv, std::span<const uint32_t> fragmentSpirv, Blend blend) {
  PipelineSpec spec;
  spec.vertexSpirv = vertexSpirv;
  spec.fragmentSpirv = fragmentSpirv;
  spec.depth = DepthUse::whereNothing;
  spec.blend = blend;
  return spec;
}

PipelineSpec domeSpec() {
  PipelineSpec spec = backdropSpec(k_sky_dome_vert, k_sky_dome_frag, Blend::none);
  spec.isStrip = true;
  return spec;
}

PipelineSpec starSpec() {
  PipelineSpec spec = backdropSpec(k_star_vert, k_star_frag, Blend::add);
  spec.bindings = {{0, sizeof(StarInstance), vk::VertexInputRate::eInstance}};
  spec.attributes = {{0, 0, vk::Format::eR32G32B32A32Sfloat, offsetof(StarInstance, ndc)},
                     {1, 0, vk::Format::eR32G32B32A32Sfloat, offsetof(StarInstance, direction_eye)}};
  return spec;
}

PipelineSpec cloudSpec() {
  PipelineSpec spec;
  spec.vertexSpirv = k_cloud_vert;
  spec.fragmentSpirv = k_cloud_frag;
  spec.depth = DepthUse::test;
  spec.blend = Blend::alpha;
  return spec;
}

}  // namespace

TextureFilter filterOn(const GpuDevice& gpu, TextureFilter filter) {
  if (filter != TextureFilter::device) return filter;
  return gpu.traits.drawsAnisotropic  ? TextureFilter::anisotropic
         : gpu.traits.blendsMipLevels ? TextureFilter::trilinear
                                      : TextureFilter::bilinear;
}

ScenePass::ScenePass(const GpuDevice& gpu, const vk::raii::PipelineCache& cache, const SceneOptions& options) {
  frame_ = createBuffer(gpu, sizeof(shader::FrameData), vk::BufferUsageFlagBits::eUniformBuffer, MemoryUse::upload);
  starBuffer_ = createBuffer(gpu, stars().size() * sizeof(StarInstance), vk::BufferUsageFlagBits::eVertexBuffer,
                             MemoryUse::upload);
  sampler_ = createSampler(gpu, filterOn(gpu, options.filter));
  setLayout_ = createSetLayout(gpu);
  const std::array sizes{vk::DescriptorPoolSize(Type::eUniformBuffer, 1),
                         vk::DescriptorPoolSize(Type::eCombinedImageSampler, 1)};
  pool_ = vk::raii::DescriptorPool(
      gpu.device, vk::DescriptorPoolCreateInfo(vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet, 1, sizes));
  set_ = std::move(vk::raii::DescriptorSets(gpu.device, vk::DescriptorSetAllocateInfo(*pool_, *setLayout_)).front());
  layout_ = vk::raii::PipelineLayout(gpu.device, vk::PipelineLayoutCreateInfo({}, *setLayout_));
  const vk::PushConstantRange face(Stage::eFragment, 0, sizeof(shader::CloudFace));
  cloudLayout_ = vk::raii::PipelineLayout(gpu.device, vk::PipelineLayoutCreateInfo({}, *setLayout_, face));
  const auto make = [&](PipelineSpec spec) {
    if (!spec.layout) spec.layout = *layout_;
    spec.colourFormat = options.colourFormat;
    spec.depthFormat = kDepthFormat;
    spec.samples = options.samples;
    return createPipeline(gpu, cache, spec);
  };
  PipelineSpec terrain = terrainSpec(), wide = wideSpec();
  if (options.bend) terrain.vertexConstants = wide.vertexConstants = bendConstants(*options.bend);
  terrain_ = make(terrain);
  wide_ = make(std::move(wide));
  if (options.samples != vk::SampleCountFlagBits::e1) {
    terrain.fragmentSpirv = {};
    terrain.layout = *layout_;
    terrain.depthFormat = kDepthFormat;
    depthAtCentres_ = createPipeline(gpu, cache, terrain);
  }
  if (options.withTints) tinted_ = make(tintedSpec());
  sky_ = make(backdropSpec(k_sky_vert, k_sky_frag, Blend::none));
  domeSky_ = make(domeSpec());
  sun_ = make(backdropSpec(k_sun_vert, k_sun_frag, Blend::add));
  star_ = make(starSpec());
  PipelineSpec cloud = cloudSpec();
  cloud.layout = *cloudLayout_;
  cloud_ = make(std::move(cloud));
  const vk::DescriptorBufferInfo frame(*frame_.buffer, 0, VK_WHOLE_SIZE);
  gpu.device.updateDescriptorSets(vk::WriteDescriptorSet(*set_, EYE_BIND_FRAME, 0, Type::eUniformBuffer, {}, frame),
                                  nullptr);
}

void ScenePass::bindTextures(const GpuDevice& gpu, const GpuImage& textures) {
  const vk::DescriptorImageInfo info(*sampler_, *textures.view, vk::ImageLayout::eShaderReadOnlyOptimal);
  gpu.device.updateDescriptorSets(
      vk::WriteDescriptorSet(*set_, EYE_BIND_TEXTURES, 0, Type::eCombinedImageSampler, info), nullptr);
}

void ScenePass::placeSky(const FrameInput& input, const View& columns, bool byPixel) {
  const glm::vec4 up = frame().up_ecef;
  dome_.reset();
  under_ = input.background;
  if (!byPixel && up.w < kDomeTopM) {
    const double lowestRad = input.hidesBelowHorizon ? horizonRad(up.w, kDeepestGroundM) : domeRingRad(0);
    dome_ = domePart(columns, Vec3d(up), Vec3d(frame().domeAhead_ecef), lowestRad);
    if (input.hidesBelowHorizon && !under_) under_ = glm::vec3(frame().horizon) * frame().skyLight.w;
  }
  eye::placeStars(input, placedStars_);
  std::ranges::copy(placedStars_, starBuffer_.as<StarInstance>().begin());
}

void ScenePass::begin(const vk::raii::CommandBuffer& commands, const Targets& targets, Pass pass) const {
  const bool isSampled = targets.isSampled(), begins = pass == Pass::first || pass == Pass::whole;
  // The last frame may have copied from both.
  const Usage copied = usageDiscarded(vk::PipelineStageFlagBits2::eTransfer);
  const Usage colourBefore = begins ? copied : usageColourTarget(), depthBefore = begins ? copied : usageDepthTarget();
  std::vector barriers{imageBarrier(targets.colour, colourBefore, usageColourTarget()),
                       imageBarrier(isSampled ? targets.depthSamples : targets.depth, depthBefore, usageDepthTarget())};
  if (isSampled) barriers.push_back(imageBarrier(targets.colourSamples, colourBefore, usageColourTarget()));
  recordBarriers(commands, barriers);
  using Load = vk::AttachmentLoadOp;
  vk::RenderingAttachmentInfo colour, depth;
  colour.setImageView(isSampled ? *targets.colourSamples.view : *targets.colour.view);
  colour.setImageLayout(vk::ImageLayout::eColorAttachmentOptimal);
  if (isSampled && pass != Pass::first && pass != Pass::between) {
    colour.setResolveMode(vk::ResolveModeFlagBits::eAverage).setResolveImageView(*targets.colour.view);
    colour.setResolveImageLayout(vk::ImageLayout::eColorAttachmentOptimal);
  }
  const bool goesOn = pass == Pass::goesOn || pass == Pass::between;
  colour.setLoadOp(goesOn ? Load::eLoad : under_ ? Load::eClear : Load::eDontCare);
  if (under_) colour.setClearValue(vk::ClearColorValue(under_->r, under_->g, under_->b, 1.0f));
  depth.setImageView(isSampled ? *targets.depthSamples.view : *targets.depth.view);
  depth.setImageLayout(vk::ImageLayout::eDepthAttachmentOptimal);
  depth.setLoadOp(goesOn ? Load::eLoad : Load::eClear);
  depth.setClearValue(vk::ClearDepthStencilValue(static_cast<float>(EYE_CLEAR_DEPTH), 0));
  vk::RenderingInfo info;
  info.setColorAttachments(colour).setPDepthAttachment(&depth);
  beginWith(commands, targets, info);
}

// Viewport, scissor and descriptors are those of every pass.
void ScenePass::beginWith(const vk::raii::CommandBuffer& commands, const Targets& targets,
                          vk::RenderingInfo info) const {
  info.setRenderArea(targets.area).setLayerCount(1);
  commands.beginRendering(info);
  commands.setViewport(
      0, vk::Viewport(0, 0, static_cast<float>(targets.widthPx), static_cast<float>(targets.heightPx), 0, 1));
  commands.setScissor(0, targets.area);
  commands.setFrontFace(flips_ ? vk::FrontFace::eClockwise : vk::FrontFace::eCounterClockwise);
  commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, *layout_, 0, *set_, nullptr);
}

void ScenePass::drawDepthAtCentres(const vk::raii::CommandBuffer& commands, const GpuDevice& gpu,
                                   const Targets& targets, const IndirectDraws& indirect, uint32_t count) const {
  const Usage copied = usageDiscarded(vk::PipelineStageFlagBits2::eTransfer);
  const std::array barriers{imageBarrier(targets.depth, copied, usageDepthTarget())};
  recordBarriers(commands, barriers);
  vk::RenderingAttachmentInfo depth;
  depth.setImageView(*targets.depth.view).setImageLayout(vk::ImageLayout::eDepthAttachmentOptimal);
  depth.setLoadOp(vk::AttachmentLoadOp::eClear);
  depth.setClearValue(vk::ClearDepthStencilValue(static_cast<float>(EYE_CLEAR_DEPTH), 0));
  vk::RenderingInfo info;
  info.setPDepthAttachment(&depth);
  beginWith(commands, targets, info);
  drawWith(depthAtCentres_, commands, gpu, indirect, 0, count);
  end(commands);
}

void ScenePass::drawTerrain(HazeBy haze, const vk::raii::CommandBuffer& commands, const GpuDevice& gpu,
                            const IndirectDraws& indirect, uint32_t first, uint32_t count) const {
  if (count == 0) return;
  drawWith(haze == HazeBy::vertex ? terrain_ : wide_, commands, gpu, indirect, first, count);
}

void ScenePass::drawTinted(const vk::raii::CommandBuffer& commands, const GpuDevice& gpu, const IndirectDraws& indirect,
                           uint32_t count) const {
  drawWith(tinted_, commands, gpu, indirect, 0, count);
}

void ScenePass::drawWith(const vk::raii::Pipeline& pipeline, const vk::raii::CommandBuffer& commands,
                         const GpuDevice& gpu, const IndirectDraws& indirect, uint32_t first, uint32_t count) const {
  commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *pipeline);
  commands.bindVertexBuffers(0, {indirect.vertices, indirect.records}, {0, 0});
  commands.bindIndexBuffer(indirect.indices, 0, vk::IndexType::eUint16);
  constexpr uint32_t kStride = sizeof(vk::DrawIndexedIndirectCommand);
  const uint32_t most = gpu.traits.mostDraws;
  for (uint32_t done = 0; done < count; done += std::min(most, count - done)) {
    commands.drawIndexedIndirect(indirect.commands, vk::DeviceSize{first + done} * kStride,
                                 std::min(most, count - done), kStride);
  }
}

void ScenePass::drawSky(const vk::raii::CommandBuffer& commands) const {
  if (dome_) {
    commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *domeSky_);
    commands.draw(2 * dome_->rings, dome_->strips, 2 * dome_->firstRing, dome_->firstStrip);
  } else {
    commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *sky_);
    commands.draw(3, 1, 0, 0);
  }
  constexpr uint32_t kSpotVertices = 6;
  commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *sun_);
  commands.draw(kSpotVertices, 1, 0, 0);
  if (placedStars_.empty()) return;
  commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *star_);
  commands.bindVertexBuffers(0, *starBuffer_.buffer, {0});
  commands.draw(kSpotVertices, static_cast<uint32_t>(placedStars_.size()), 0, 0);
}

void ScenePass::drawClouds(const vk::raii::CommandBuffer& commands) const {
  if (clouds_.empty()) return;
  commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *cloud_);
  commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, *cloudLayout_, 0, *set_, nullptr);
  for (const shader::CloudFace& face : clouds_) {
    commands.pushConstants<shader::CloudFace>(*cloudLayout_, Stage::eFragment, 0, face);
    commands.draw(3, 1, 0, 0);
  }
}

}  // namespace eye
