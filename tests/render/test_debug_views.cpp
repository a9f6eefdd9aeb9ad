// The views of culling itself: colours where they belong, and nothing of them in other frames.
#include <catch2/catch.hpp>

#include "render/scene.h"
#include "render/tint_lists.h"

using namespace eye;
using namespace eye::test;

namespace {

constexpr int kWidth = 200, kHeight = 150;

RendererOptions options(bool debugViews) {
  RendererOptions options;
  options.widthPx = kWidth;
  options.heightPx = kHeight;
  options.validate = true;
  options.debugViews = debugViews;
  return options;
}

std::vector<uint8_t> draw(Renderer& renderer, const FrameInput& input) {
  const auto frame = renderer.drawFrame(input);
  if (!frame) FAIL(frame.error().message);
  return {frame->rgba.begin(), frame->rgba.end()};
}

// Pixels of about the tint's hue: the channels in its order, well apart.
int pixelsLike(const std::vector<uint8_t>& rgba, const glm::vec3& tint) {
  int count = 0;
  for (size_t i = 0; i < rgba.size(); i += 4) {
    const glm::vec3 colour(rgba[i], rgba[i + 1], rgba[i + 2]);
    const float brightest = std::max({colour.r, colour.g, colour.b});
    count += brightest > 30 && glm::length(glm::normalize(colour) - glm::normalize(tint)) < 0.35f;
  }
  return count;
}

FrameInput lookBetweenRidges(const std::vector<ChunkDraw>& draws) {
  FrameInput input = lookFrom({{49, 20, ridgesM(49, 20) + 60}, 40, 0, 0}, kWidth, kHeight);
  input.draws = draws;
  input.depthMapPx = glm::ivec2(100, 75);
  input.background = glm::vec3(1.0f);
  return input;
}

}  // namespace

TEST_CASE("what culling makes of each cluster is coloured, in this view and from outside") {
  RendererOptions made = options(true);
  made.cullBy = GENERATE(CullBy::compute, CullBy::host);
  const auto renderer = makeRenderer(made);
  if (!renderer) return;
  const std::vector<ChunkDraw> draws = mountains(*renderer, 7, ecefFromGeodetic({49, 20, 2500}));
  FrameInput input = lookBetweenRidges(draws);
  const std::vector<uint8_t> plain = draw(*renderer, input);
  for (int frame = 0; frame < 3; ++frame) draw(*renderer, input);
  input.tint = Tint::fate;
  const std::vector<uint8_t> inside = draw(*renderer, input);
  const glm::vec3 green = tintOfFate(EYE_FATE_VISIBLE), red = tintOfFate(EYE_FATE_OCCLUDED);
  CHECK(pixelsLike(plain, red) == 0);
  CHECK(pixelsLike(inside, green) > kWidth * kHeight / 5);
  CHECK(pixelsLike(inside, red) == 0);  // what is hidden shows nowhere

  FrameInput away = lookFrom({{49, 20, 9000}, 40, -60, 0}, kWidth, kHeight);
  away.draws = draws;
  away.depthMapPx = input.depthMapPx;
  away.background = input.background;
  away.freezeCulling = true;
  away.tint = Tint::fate;
  for (int frame = 0; frame < 2; ++frame) {  // frozen frames do not forget
    const std::vector<uint8_t> outside = draw(*renderer, away);
    CHECK(pixelsLike(outside, green) > 100);
    CHECK(pixelsLike(outside, red) > 100);
  }
  // Nothing stays in frames that do not ask for it.
  input.tint = Tint::none;
  CHECK((draw(*renderer, input) == plain));
  CHECK(renderer->validationMessages() == 0);
}

TEST_CASE("levels of detail are coloured, skirts too") {
  const auto renderer = makeRenderer(options(true));
  if (!renderer) return;
  std::vector<ChunkDraw> draws = mountains(*renderer, 7, ecefFromGeodetic({49, 20, 2500}));
  FrameInput input = lookBetweenRidges(draws);
  input.draws = draws;
  input.tint = Tint::level;
  const int all = pixelsLike(draw(*renderer, input), tintOfLevel(0));
  CHECK(all > kWidth * kHeight / 5);
  for (size_t i = 0; i < draws.size(); i += 2) draws[i].level = 2;
  const std::vector<uint8_t> mixed = draw(*renderer, input);
  CHECK(pixelsLike(mixed, tintOfLevel(0)) < all);
  CHECK(pixelsLike(mixed, tintOfLevel(2)) > 100);
  input.depthMapPx.reset();
  CHECK((draw(*renderer, input) == mixed));
  CHECK(renderer->validationMessages() == 0);
}

TEST_CASE("the depth map is shown in the lower left where there is one, and the picture above it is as before") {
  const auto renderer = makeRenderer(options(true));
  if (!renderer) return;
  const std::vector<ChunkDraw> draws = mountains(*renderer, 7, ecefFromGeodetic({49, 20, 2500}));
  FrameInput input = lookBetweenRidges(draws);
  const std::vector<uint8_t> plain = draw(*renderer, input);
  input.showDepthMap = true;
  const std::vector<uint8_t> shown = draw(*renderer, input);
  const auto differing = [&](int firstRow, int rows) {
    int count = 0;
    for (size_t i = size_t(firstRow) * kWidth * 4; i < size_t(firstRow + rows) * kWidth * 4; i += 4)
      count += !std::equal(&plain[i], &plain[i] + 4, &shown[i]);
    return count;
  };
  // 0.45 of the width by 3 / 4 of that, eight pixels above the lower edge.
  CHECK(differing(0, kHeight / 2 - 8) == 0);
  CHECK(differing(kHeight / 2, kHeight / 2) > 4000);
  input.depthMapPx.reset();
  CHECK((draw(*renderer, input) == plain));
  CHECK(renderer->validationMessages() == 0);
}

TEST_CASE("no texel of a depth map covers more pixels than a shader's loop may count") {
  RendererOptions large = options(false);
  large.widthPx = 640;
  large.heightPx = 480;
  large.cullBy = CullBy::compute;
  const auto renderer = makeRenderer(large);
  if (!renderer) return;
  const std::vector<ChunkDraw> draws = mountains(*renderer, 7, ecefFromGeodetic({49, 20, 2500}));
  FrameInput input = lookFrom({{49, 20, ridgesM(49, 20) + 60}, 40, 0, 0}, large.widthPx, large.heightPx);
  input.draws = draws;
  const std::vector<uint8_t> plain = draw(*renderer, input);
  input.depthMapPx = glm::ivec2(1, 1);
  for (int frame = 0; frame < 3; ++frame) CHECK((draw(*renderer, input) == plain));
  const CullReadBack gpu = renderer->readCulling();
  CHECK(gpu.params.mapPx == glm::ivec2(5, 4));
  CHECK(gpu.pyramid.back() == *std::ranges::min_element(gpu.depth));
}
