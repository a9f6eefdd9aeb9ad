// Several samples a pixel and ways of reading textures: what a user may choose of a picture's quality.
#include <catch2/catch.hpp>

#include "render/scene.h"

using namespace eye;
using namespace eye::test;

namespace {

constexpr int kWidth = 320, kHeight = 240;

struct Kept {
  std::vector<uint8_t> rgba;
  std::vector<float> depth;
};

Kept draw(Renderer& renderer, FrameInput input) {
  input.readColour = input.readDepth = true;
  const auto frame = renderer.drawFrame(input);
  if (!frame) FAIL(frame.error().message);
  return {{frame->rgba.begin(), frame->rgba.end()}, {frame->depth.begin(), frame->depth.end()}};
}

RendererOptions options(int samples, TextureFilter filter = TextureFilter::device) {
  RendererOptions made;
  made.widthPx = kWidth;
  made.heightPx = kHeight;
  made.validate = true;
  made.samples = samples;
  made.filter = filter;
  return made;
}

const Pose kPose{{49.0 - 0.2, 20.0, 3000}, 0, -8, 0};

}  // namespace

TEST_CASE("four samples smooth edges and leave depth at the pixels' centres, validation clean") {
  Kept kept[2];
  for (const int samples : {1, 4}) {
    const auto renderer = makeRenderer(options(samples));
    if (!renderer) return;
    FrameInput input = lookFrom(kPose, kWidth, kHeight);
    const std::vector<ChunkDraw> draws = mountains(*renderer, 13, input.view.eyeEcefM);
    input.draws = draws;
    kept[samples > 1] = draw(*renderer, input);
    CHECK(renderer->validationMessages() == 0);
  }
  CHECK((kept[0].depth == kept[1].depth));
  size_t same = 0, edges = 0;
  double sums[2] = {0, 0};
  for (size_t i = 0; i < kept[0].rgba.size(); ++i) {
    const int difference = std::abs(int{kept[0].rgba[i]} - int{kept[1].rgba[i]});
    same += difference <= 2;
    edges += difference > 16;
    for (size_t s = 0; s < 2; ++s) sums[s] += kept[s].rgba[i];
  }
  const double values = static_cast<double>(kept[0].rgba.size());
  CHECK(static_cast<double>(same) > 0.8 * values);
  CHECK(static_cast<double>(edges) > 0.001 * values);
  CHECK(std::abs(sums[0] - sums[1]) / values < 1);  // no brighter and no darker
}

TEST_CASE("the depth map of four samples holds a pixel's farthest") {
  RendererOptions made = options(4);
  made.cullBy = GENERATE(CullBy::compute, CullBy::host);
  const auto renderer = makeRenderer(made);
  if (!renderer) return;
  // Black ground before magenta: a pixel of another colour than black sees past the ground with some sample.
  const Patch patch{48.95, 19.95, 49.05, 20.05, 28, 0.25};
  const MadeChunk chunk = makeChunk(patch, ridgesM, flatTexture(made.textureSize, 0, 0, 0));
  const std::vector<ChunkDraw> draws{addChunk(*renderer, chunk)};
  FrameInput input = lookFrom({{48.9, 20.0, 2000}, 0, -8, 0}, kWidth, kHeight);
  input.draws = draws;
  input.background = glm::vec3(1, 0, 1);
  input.depthMapPx = glm::ivec2(kWidth, kHeight);
  Kept kept;
  for (int frame = 0; frame < 3; ++frame) kept = draw(*renderer, input);
  const std::vector<float> farthest = renderer->readCulling().depth;
  size_t mixed = 0, wrong = 0;
  for (size_t i = 0; i < farthest.size(); ++i) {
    const uint8_t red = kept.rgba[4 * i];
    mixed += red > 2 && red < 253;
    wrong += (red > 2) != (farthest[i] == 0);
  }
  CHECK(mixed > 100);
  CHECK(wrong == 0);
  CHECK(renderer->validationMessages() == 0);
}

TEST_CASE("each sampler draws its own picture, the device's is one of them") {
  std::vector<Kept> kept;
  for (const TextureFilter filter : {TextureFilter::device, TextureFilter::nearest, TextureFilter::bilinear,
                                     TextureFilter::trilinear, TextureFilter::anisotropic}) {
    const auto renderer = makeRenderer(options(1, filter));
    if (!renderer && filter == TextureFilter::anisotropic) {
      WARN("this device has no anisotropic filter");
      kept.push_back({});
      continue;
    }
    if (!renderer) return;
    if (filter != TextureFilter::device) CHECK(renderer->textureFilter() == filter);
    CHECK(renderer->textureFilter() != TextureFilter::device);
    FrameInput input = lookFrom(kPose, kWidth, kHeight);
    const std::vector<ChunkDraw> draws = mountains(*renderer, 13, input.view.eyeEcefM);
    input.draws = draws;
    kept.push_back(draw(*renderer, input));
    CHECK(renderer->validationMessages() == 0);
  }
  CHECK((kept[1].rgba != kept[2].rgba));
  CHECK((kept[2].rgba != kept[3].rgba));
  if (!kept[4].rgba.empty()) {
    CHECK((kept[3].rgba != kept[4].rgba));
    CHECK((kept[1].depth == kept[4].depth));
  }
  CHECK((kept[0].rgba == kept[2].rgba || kept[0].rgba == kept[3].rgba || kept[0].rgba == kept[4].rgba));
  CHECK((kept[1].depth == kept[3].depth));
}
