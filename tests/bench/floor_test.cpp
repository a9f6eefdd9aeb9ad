// The triangles of the floor against a brute force, and its replay against the frame.
#include <set>

#include <catch2/catch.hpp>

#include "bench/floor_study.h"
#include "bench/small_database.h"

namespace eye {
namespace {

constexpr int kWidth = 64, kHeight = 48;

std::optional<SteeredGenerator> generatorOf(CullingMode culling, glm::ivec2 sizePx) {
  const auto devices = Renderer::listDevices();
  if (!devices || devices->empty()) {
    WARN("no Vulkan device: not tested");
    return std::nullopt;
  }
  Options options;
  options.terrain = smallDatabase();
  options.culling = culling;
  options.widthPx = sizePx.x;
  options.heightPx = sizePx.y;
  options.ssePx = 0.5;
  if (culling == CullingMode::dynamic) {
    options.depthMap = DepthMapMode::fixed;
    options.depthMapPx = {64, 48};
  }
  auto made = SteeredGenerator::create(options);
  if (!made) FAIL(made.error().message);
  return std::move(*made);
}

BenchView wideView(const DatabaseReader& reader) {
  const auto places = findPlaces(reader);
  REQUIRE(places);
  return benchViews(*places)[4];
}

// 1/z along the ray, 0 where it misses the triangle or meets its back (Moeller and Trumbore 1997).
double inverseZAlong(const Vec3d& ray, const std::array<Vec3d, 3>& c) {
  const Vec3d e1 = c[1] - c[0], e2 = c[2] - c[0], p = glm::cross(ray, e2);
  const double det = glm::dot(e1, p);
  if (det <= 0) return 0;
  const Vec3d s = -c[0], q = glm::cross(s, e1);
  const double u = glm::dot(s, p) / det, v = glm::dot(ray, q) / det, t = glm::dot(e2, q) / det;
  return u < 0 || v < 0 || u + v > 1 || t <= 0 ? 0 : 1 / t;
}

}  // namespace

TEST_CASE("the floor's triangles are those that a ray through some pixel's centre meets first") {
  const Result<DatabaseReader> reader = DatabaseReader::open(smallDatabase());
  REQUIRE(reader);
  for (const CullingMode culling : {CullingMode::frustum, CullingMode::dynamic}) {
    auto generator = generatorOf(culling, {kWidth, kHeight});
    if (!generator) return;
    const BenchView view = wideView(*reader);
    for (int i = 0; i < 3; ++i) REQUIRE(generator->frame(view.pose));
    ChunkShelf shelf(*reader);
    const Result<DrawnTriangles> drawn = drawnTriangles(generator->generator(), shelf);
    REQUIRE(drawn);
    const FrameInput input = generator->generator().lastInput();

    std::set<std::pair<size_t, size_t>> marked, met;  // run and triangle
    std::vector<double> nearest(kWidth * kHeight, 0);
    std::vector<std::pair<size_t, size_t>> shown(kWidth * kHeight);
    for (size_t r = 0; r < drawn->runs.size(); ++r) {
      const DrawnRun& run = drawn->runs[r];
      const CornerPlaces at(input.draws[run.draw], *drawn->chunks[run.draw], run.skirtSide, input.view.eyeEcefM);
      for (size_t t = 0; t < run.fates.size(); ++t) {
        if (run.fates[t] == TriangleFate::visible) marked.insert({r, t});
        if (run.fates[t] == TriangleFate::notSubmitted) continue;
        const size_t first = run.firstIndex + 3 * t;
        const std::array<Vec3d, 3> corners{at[first], at[first + 1], at[first + 2]};
        for (int i = 0; i < kWidth * kHeight; ++i) {
          const Vec3d eye = rayThroughPixel(input.view.frustum, kWidth, kHeight, i % kWidth, i / kWidth);
          const double inverseZ = inverseZAlong(glm::transpose(input.view.eyeFromEcef) * eye, corners);
          const auto pixel = static_cast<size_t>(i);
          if (inverseZ <= nearest[pixel]) continue;
          nearest[pixel] = inverseZ;
          shown[pixel] = {r, t};
        }
      }
    }
    size_t terrainPx = 0;
    for (size_t i = 0; i < nearest.size(); ++i) {
      if (nearest[i] > 0) met.insert(shown[i]);
      terrainPx += nearest[i] > 0;
    }
    CHECK(met.size() > 20);
    CHECK((marked == met));
    CHECK(drawn->terrainPx == terrainPx);
    CHECK(drawn->count(TriangleFate::offScreen) > 0);
    CHECK(drawn->submitted() > drawn->count(TriangleFate::visible));
  }
}

TEST_CASE("the floor's replay shows the frame, and each of its steps more triangles") {
  const Result<DatabaseReader> reader = DatabaseReader::open(smallDatabase());
  REQUIRE(reader);
  auto generator = generatorOf(CullingMode::dynamic, {320, 240});
  if (!generator) return;
  ChunkShelf shelf(*reader);
  const uint64_t before = generator->generator().renderer().bytesResident();
  const Result<FloorView> floor = measureFloor(*generator, wideView(*reader), shelf, {.frames = 4, .settle = 3});
  REQUIRE(floor);
  CHECK(floor->visible > 0);
  CHECK(floor->visible < floor->covering);
  CHECK(floor->covering <= floor->facing);
  CHECK(floor->facing <= floor->onScreen);
  CHECK(floor->onScreen < floor->submitted);
  CHECK(floor->isCulled);
  // A rasteriser rounds corners to a 256th of a pixel: some pixels at edges are another triangle's, few of them a hole.
  CHECK(floor->differingPx < 320 * 240 / 500);
  CHECK(floor->cpuMs.visible > 0);
  CHECK(floor->cpuMs.frame > 0);
  CHECK(floorRatio({*floor}) == Approx(floor->cpuMs.frame / floor->cpuMs.visible));
  // What was uploaded for it is given back.
  const uint64_t after = generator->generator().renderer().bytesResident();
  REQUIRE(generator->frame(wideView(*reader).pose));
  CHECK(generator->generator().renderer().bytesResident() == after);
  CHECK(after >= before);
}

}  // namespace eye
