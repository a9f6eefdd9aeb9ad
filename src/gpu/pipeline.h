// Pipelines: one description, one call. Graphics pipelines are for dynamic rendering; viewport, scissor and, where
// faces are culled, the front face are dynamic.
#pragma once

#include <span>
#include <vector>

#include "gpu/device.h"

namespace eye {

enum class DepthUse {
  none,
  testAndWrite,  // nearer pixels win
  whereNothing,  // only where the cleared depth still stands; writes no depth
  test,          // only before what stands there; writes no depth
};

// What becomes of the colour that is there.
enum class Blend {
  none,   // it is written over, alpha too
  add,    // the new one is added; alpha stays
  alpha,  // the new one covers it by its alpha; alpha stays
};

struct PipelineSpec {
  std::span<const uint32_t> vertexSpirv, fragmentSpirv;  // no fragment shader: depth alone
  vk::PipelineLayout layout;
  std::vector<vk::VertexInputBindingDescription> bindings;
  std::vector<vk::VertexInputAttributeDescription> attributes;
  vk::Format colourFormat = vk::Format::eUndefined;  // undefined: the pass has no colour
  vk::SampleCountFlagBits samples = vk::SampleCountFlagBits::e1;
  vk::Format depthFormat = vk::Format::eUndefined;  // of the pass, used or not
  DepthUse depth = DepthUse::none;
  std::vector<uint32_t> vertexConstants{};  // the vertex shader's specialization constants 0, 1, 2 ..., as bits
  bool isStrip = false;                     // triangle strips instead of single triangles
  Blend blend = Blend::none;
  vk::CullModeFlags cull = vk::CullModeFlagBits::eNone;
};

vk::raii::Pipeline createPipeline(const GpuDevice& gpu, const vk::raii::PipelineCache& cache, const PipelineSpec& spec);
// `constant`: the specialization constant 0.
vk::raii::Pipeline createComputePipeline(const GpuDevice& gpu, const vk::raii::PipelineCache& cache,
                                         std::span<const uint32_t> spirv, vk::PipelineLayout layout,
                                         std::optional<int32_t> constant = {});

}  // namespace eye
