#include "render/warm_up.h"

#include <imgui.h>

#include <array>

#include "render/sky_dome.h"
#include "terrain/chunk_codec.h"

namespace eye {
namespace {

// One triangle of 20 km, counterclockwise from above, about the point 0 N 0 E.
LoadedChunk triangle(int textureSize) {
  LoadedChunk chunk;
  chunk.mesh.vertices = {
      {0, -10000, -10000, 0, 0, 0, 0, 0}, {0, 10000, -10000, 0, 65535, 0, 0, 0}, {0, 0, 10000, 0, 0, 65535, 0, 0}};
  chunk.mesh.indices = {0, 1, 2};
  chunk.surfaceIndexCount = 3;
  chunk.mesh.clusters = {{.firstIndex = 0, .indexCount = 3, .boxMax = {65535, 65535, 65535}}};
  chunk.texels.assign(mipChainBytes(textureSize), 128);
  return chunk;
}

}  // namespace

Result<void> warmUp(Renderer& renderer, const RendererOptions& options) {
  const auto gpu = renderer.upload(triangle(options.textureSize));
  if (!gpu) return fail(ErrorKind::usage, "the GPU budget holds not one chunk: give a larger --cache-gpu");
  ChunkDraw draw;
  draw.gpu = *gpu;
  draw.originLattice = LatticePoint(static_cast<int64_t>(kSemiMajorM), 0, 0);
  draw.box = {Vec3d(kSemiMajorM, 0, 0), {Vec3d(0, 10000, 0), Vec3d(0, 0, 10000), Vec3d(1, 0, 0)}};
  draw.upEcef = {1, 0, 0};
  draw.textureLayer = static_cast<uint32_t>(gpu->textureLayer);
  FrameInput input;
  input.lighting.clouds[0] = {.baseM = 12000, .topM = 13000, .coverage = 0.5};
  const Pose pose{{0, 0, 10000}, 0, -90, 0};
  input.view =
      makeView(pose, symmetricFrustum(60, options.widthPx, options.heightPx, 1), options.widthPx, options.heightPx);
  std::array draws{draw, draw};
  draws[0].longestEdgeM = 0;  // both ways of drawing haze
  input.draws = draws;
  input.overlay = [] {
    ImGui::Begin("warm-up");
    ImGui::TextUnformatted("every pipeline draws once");
    ImGui::End();
  };
  auto drawn = renderer.drawFrame(input);
  input.depthMapPx = glm::ivec2(32, 24);
  const Pose above{{0, 0, 2 * kDomeTopM}, 0, -60, 0};  // where the sky is drawn by pixel
  input.view =
      makeView(above, symmetricFrustum(60, options.widthPx, options.heightPx, 1), options.widthPx, options.heightPx);
  input.lighting.sunDirectionEcef = {-1, 0, 0};  // night: the stars are out
  if (options.debugViews) {
    input.tint = Tint::level;
    input.showDepthMap = true;
  }
  input.readDepth = options.samples > 1;
  if (drawn) drawn = renderer.drawFrame(input);
  renderer.release(*gpu);
  if (!drawn) return tl::unexpected(drawn.error());
  return {};
}

}  // namespace eye
