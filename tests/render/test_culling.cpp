// Occlusion culling: never a pixel, and the GPU decides as its CPU mirror does.
#include <catch2/catch.hpp>

#include <map>
#include <numeric>
#include <random>

#include "render/cull_lists.h"
#include "render/cull_mirror.h"
#include "render/scene.h"
#include "shared/cull.h"

using namespace eye;
using namespace eye::test;

namespace {

constexpr int kWidth = 200, kHeight = 150;

RendererOptions options() {
  RendererOptions options;
  options.widthPx = kWidth;
  options.heightPx = kHeight;
  options.validate = true;
  return options;
}

RendererOptions culledBy(CullBy cullBy) {
  RendererOptions made = options();
  made.cullBy = cullBy;
  return made;
}

struct Picture {
  std::vector<uint8_t> rgba;
  std::vector<float> depth;
  CullCounts clusters;
  bool operator==(const Picture& other) const { return rgba == other.rgba && depth == other.depth; }
};

Picture draw(Renderer& renderer, const FrameInput& input) {
  const auto frame = renderer.drawFrame(input);
  if (!frame) FAIL(frame.error().message);
  return {{frame->rgba.begin(), frame->rgba.end()}, {frame->depth.begin(), frame->depth.end()}, frame->clusters};
}

// Low between the ridges, in any attitude.
Pose randomPose(std::mt19937& random) {
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  const double lat = uniform(48.95, 49.05), lon = uniform(19.93, 20.07);
  const double aboveM = std::exp(uniform(std::log(5.0), std::log(1000.0)));
  return {{lat, lon, ridgesM(lat, lon) + aboveM}, uniform(0, 360), uniform(-40, 20), uniform(-60, 60)};
}

// 1 for each fate that has the flag.
std::vector<uint32_t> withFlag(const std::vector<uint32_t>& fates, uint32_t flag) {
  std::vector<uint32_t> has;
  for (const uint32_t fate : fates) has.push_back((fate & flag) != 0 ? 1 : 0);
  return has;
}

size_t differing(const std::vector<uint32_t>& a, const std::vector<uint32_t>& b) {
  if (a.size() != b.size()) return std::max(a.size(), b.size());
  size_t count = 0;
  for (size_t i = 0; i < a.size(); ++i) count += a[i] != b[i];
  return count;
}

// Triangles that commands draw.
size_t drawnIn(const CullReadBack& gpu, std::vector<shader::DrawCommand> CullReadBack::BandDraws::*commands) {
  const std::optional<TriangleTimes> drawn = trianglesDrawn(gpu, commands);
  REQUIRE(drawn);
  size_t sum = 0;
  for (const std::vector<uint32_t>& cluster : *drawn) sum += std::accumulate(cluster.begin(), cluster.end(), size_t{0});
  return sum;
}

// What is drawn early is what the frame before found visible, in the pool's clusters, and this one in view and facing.
std::vector<uint32_t> earlyOf(const CullReadBack& gpu, const CullMirror& cpu, const std::vector<bool>& wasVisible) {
  std::vector<uint32_t> early;
  for (size_t i = 0; i < gpu.candidates.size(); ++i) {
    const uint32_t why = cpu.fates[i] & EYE_FATE_WHY;
    early.push_back(wasVisible[gpu.candidates[i].cluster] && (why == EYE_FATE_VISIBLE || why == EYE_FATE_OCCLUDED));
  }
  return early;
}

}  // namespace

TEST_CASE("occlusion culling changes no pixel, and the GPU culls as its CPU mirror") {
  RendererOptions made = culledBy(GENERATE(CullBy::compute, CullBy::host));
  made.samples = GENERATE(1, 4);
  INFO(made.samples << " samples a pixel");
  const auto renderer = makeRenderer(made);
  if (!renderer) return;
  const std::vector<ChunkDraw> draws = mountains(*renderer, 9, ecefFromGeodetic({49, 20, 2500}));
  const glm::ivec2 maps[] = {{200, 150}, {64, 48}, {80, 61}, {37, 29}, {320, 240}, {1, 1}, {7, 1}};
  std::mt19937 random(7);
  CullCounts sum;
  std::vector<bool> wasVisible(renderer->readCulling().clusters.size());
  for (int round = 0; round < 60; ++round) {
    INFO("pose " << round);
    FrameInput input = lookFrom(randomPose(random), kWidth, kHeight, round % 3 == 0 ? 90 : 40);
    input.draws = draws;
    if (round % 5 == 4) std::swap(input.view.frustum.tanLeft, input.view.frustum.tanRight);  // mirrored
    const Picture plain = draw(*renderer, input);
    // Three times: the first draws early what another pose saw, the second what the first found, and only the third
    // spares what the second found hidden.
    for (int frame = 0; frame < 3; ++frame) {
      input.depthMapPx = maps[static_cast<size_t>(round) % std::size(maps)];
      const Picture culled = draw(*renderer, input);
      for (size_t i = 0; i < plain.depth.size(); ++i) {
        if (culled.depth[i] == plain.depth[i]) continue;
        FAIL("frame " << frame << ": depth " << culled.depth[i] << " instead of " << plain.depth[i] << " at "
                      << i % kWidth << ", " << i / kWidth);
      }
      REQUIRE((culled.rgba == plain.rgba));
      const CullReadBack gpu = renderer->readCulling();
      const CullMirror cpu = mirrorOf(gpu);
      REQUIRE((gpu.pyramid == cpu.pyramid));
      REQUIRE(differing(gpu.fates, cpu.fates) == 0);
      REQUIRE(differing(earlyOf(gpu, cpu, wasVisible), withFlag(gpu.fates, EYE_FATE_EARLY)) == 0);
      for (size_t i = 0; i < gpu.candidates.size(); ++i)
        wasVisible[gpu.candidates[i].cluster] = (cpu.fates[i] & EYE_FATE_WHY) == EYE_FATE_VISIBLE;
      REQUIRE(wrongDraws(gpu) == "");
      REQUIRE(culled.clusters.trianglesDrawn ==
              drawnIn(gpu, &CullReadBack::BandDraws::early) + drawnIn(gpu, &CullReadBack::BandDraws::late));
      sum.considered += culled.clusters.considered;
      sum.outside += culled.clusters.outside;
      sum.backFacing += culled.clusters.backFacing;
      sum.occluded += culled.clusters.occluded;
      sum.drawn += culled.clusters.drawn;
    }
    input.depthMapPx.reset();
  }
  CAPTURE(sum.considered, sum.outside, sum.backFacing, sum.occluded, sum.drawn);
  CHECK(sum.occluded > sum.drawn / 20);  // the tests above must have had something to find
  CHECK(sum.drawn > 0);
  CHECK(renderer->validationMessages() == 0);
}

TEST_CASE("the depth map's texels cover every pixel and every finer texel") {
  using namespace eye::shader;
  const int maps[] = {1, 2, 3, 7, 37, 200, 320, 801}, pictures[] = {1, 16, 200, 799, 800, 1280};
  for (const int map : maps) {
    for (const int picture : pictures) {
      for (int pixel = 0; pixel < picture; ++pixel) {
        // The texel that mapRectOf finds for the pixel's centre.
        const int texel = std::min(map - 1, static_cast<int>((pixel + 0.5) * map / picture));
        const ivec2 span = pixelSpan(texel, map, picture);
        REQUIRE((span.x <= pixel && pixel <= span.y && span.x >= 0 && span.y < picture));
      }
    }
    const int levels = pyramidLayout({map, 1}).levels;
    REQUIRE(levelSize({map, 1}, levels - 1).x == 1);
    for (int level = 1; level < levels; ++level) {
      // Halves without a gap: what covers a texel covers both of its children, and the last one is inside.
      REQUIRE(levelSize({map, 1}, level).x == (levelSize({map, 1}, level - 1).x + 1) / 2);
      for (int x = 0; x < map; ++x) {
        REQUIRE(texelAt({x, 0}, level).x == texelAt({x, 0}, level - 1).x / 2);
        REQUIRE(texelAt({x, 0}, level).x < levelSize({map, 1}, level).x);
      }
    }
  }
}

TEST_CASE("a rectangle's texels at its level are few and cover it, and no finer level has as few") {
  using namespace eye::shader;
  std::mt19937 random(3);
  for (int i = 0; i < 100000; ++i) {
    const auto within = [&](int low, int high) { return std::uniform_int_distribution(low, high)(random); };
    const ivec2 map(within(1, 900), within(1, 700));
    MapRect rect{};
    rect.low = {within(0, map.x - 1), within(0, map.y - 1)};
    rect.high = {within(rect.low.x, map.x - 1), within(rect.low.y, map.y - 1)};
    const int level = levelOf(rect);
    REQUIRE(level < pyramidLayout(map).levels);
    REQUIRE(texelsOf(rect, level) <= EYE_RECT_TEXELS);
    if (level > 0) REQUIRE(texelsOf(rect, level - 1) > EYE_RECT_TEXELS);
  }
}

TEST_CASE("a chunk in a place that another has left is not taken for visible") {
  const auto renderer = makeRenderer(culledBy(GENERATE(CullBy::compute, CullBy::host)));
  if (!renderer) return;
  const MadeChunk chunk = makeChunk({49, 20, 49.02, 20.03}, ridgesM, flatTexture(128, 90, 120, 60));
  FrameInput input = lookFrom({{49.01, 20.015, 4000}, 0, -90, 0}, kWidth, kHeight);
  input.depthMapPx = glm::ivec2(64, 48);
  for (int owner = 0; owner < 2; ++owner) {
    const std::vector<ChunkDraw> draws{addChunk(*renderer, chunk)};
    input.draws = draws;
    draw(*renderer, input);
    const CullReadBack first = renderer->readCulling();
    CHECK(drawnIn(first, &CullReadBack::BandDraws::early) == 0);
    CHECK(drawnIn(first, &CullReadBack::BandDraws::late) > 0);
    draw(*renderer, input);
    const CullReadBack second = renderer->readCulling();
    CHECK(drawnIn(second, &CullReadBack::BandDraws::early) > 0);
    CHECK(drawnIn(second, &CullReadBack::BandDraws::late) == 0);
    renderer->release(draws[0].gpu);
  }
}

TEST_CASE("frozen culling draws what was visible when it froze, wherever the eye goes") {
  const auto renderer = makeRenderer(culledBy(GENERATE(CullBy::compute, CullBy::host)));
  if (!renderer) return;
  const std::vector<ChunkDraw> draws = mountains(*renderer, 7, ecefFromGeodetic({49, 20, 2500}));
  FrameInput input = lookFrom({{49, 20, ridgesM(49, 20) + 60}, 40, 0, 0}, kWidth, kHeight);
  input.draws = draws;
  input.depthMapPx = glm::ivec2(100, 75);
  draw(*renderer, input);
  draw(*renderer, input);
  const CullReadBack before = renderer->readCulling();
  FrameInput away = lookFrom({{49, 20, 9000}, 40, -60, 0}, kWidth, kHeight);
  away.draws = draws;
  away.depthMapPx = input.depthMapPx;
  away.freezeCulling = true;
  draw(*renderer, away);
  const CullReadBack frozen = renderer->readCulling();
  std::map<uint32_t, uint32_t> fatesBefore;  // by cluster: the candidates' order is by haze, which hangs on the eye
  for (size_t i = 0; i < before.candidates.size(); ++i) fatesBefore[before.candidates[i].cluster] = before.fates[i];
  size_t drawn = 0;
  for (size_t i = 0; i < frozen.candidates.size(); ++i) {
    const bool wasVisible = (fatesBefore.at(frozen.candidates[i].cluster) & EYE_FATE_WHY) == EYE_FATE_VISIBLE;
    CHECK(((frozen.fates[i] & EYE_FATE_EARLY) != 0) == wasVisible);
    drawn += wasVisible;
  }
  CHECK(drawn > 0);
  CHECK(drawn < frozen.candidates.size());
}
