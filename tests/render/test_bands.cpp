// A picture in bands: where the edges lie, which boxes show in which band, and that no pixel depends on how many draw.
#include <catch2/catch.hpp>

#include <bit>
#include <numeric>
#include <random>

#include "render/bands.h"
#include "render/cull_mirror.h"
#include "render/scene.h"
#include "shared/cull.h"

using namespace eye;
using namespace eye::test;

namespace {

struct Picture {
  std::vector<uint8_t> rgba;
  std::vector<float> depth;
  CullCounts clusters;
  uint64_t triangles = 0;
  bool operator==(const Picture& other) const { return rgba == other.rgba && depth == other.depth; }
};

Picture draw(Renderer& renderer, const FrameInput& input) {
  const auto frame = renderer.drawFrame(input);
  if (!frame) FAIL(frame.error().message);
  return {{frame->rgba.begin(), frame->rgba.end()},
          {frame->depth.begin(), frame->depth.end()},
          frame->clusters,
          frame->triangles};
}

// With the eye at the origin, looking along x, y to the left and z up; a frustum that leans to one side.
struct Camera {
  std::vector<int> edgesPx;
  glm::vec3 clipX, clipW;
  Camera(std::vector<int> edges, float mirrored)
      : edgesPx(std::move(edges)), clipX(0.3f, -1.2f * mirrored, 0), clipW(1, 0, 0) {}

  // Column of the picture, fractions too, of a point before the eye.
  float columnPx(const glm::vec3& p) const {
    return (glm::dot(clipX, p) / glm::dot(clipW, p) + 1) / 2 * float(edgesPx.back());
  }
  uint32_t bandOf(float columnPx) const {
    uint32_t band = 0;
    while (band + 2 < edgesPx.size() && columnPx >= float(edgesPx[band + 1])) ++band;
    return 1u << band;
  }
};

}  // namespace

TEST_CASE("a band for each core, four at most, and what cores are left are the bands' own") {
  CHECK(planBands(0, 1).bands == 1);
  CHECK(planBands(0, 0).bands == 1);  // the system does not tell
  CHECK(planBands(0, 2).bands == 2);
  CHECK(planBands(0, 2).rasterThreads == 0);
  CHECK(planBands(0, 16).bands == 4);
  CHECK(planBands(0, 16).rasterThreads == 4);
  CHECK(planBands(1, 16).bands == 1);
  CHECK(planBands(3, 2).bands == 3);
  CHECK(planBands(3, 2).rasterThreads == 0);
  CHECK(planBands(9, 2).bands == 4);
}

TEST_CASE("edges lie between groups of pixels, whatever the picture's width") {
  CHECK(evenEdges(1280, 2, 8) == std::vector<int>{0, 640, 1280});
  CHECK(evenEdges(1280, 3, 64) == std::vector<int>{0, 448, 832, 1280});
  CHECK(evenEdges(8, 2, 8) == std::vector<int>{0, 8, 8});  // the second has nothing to draw
  CHECK(evenEdges(1, 4, 8) == std::vector<int>{0, 1, 1, 1, 1});
  const int step = GENERATE(8, 64);
  for (int width = 1; width < 300; ++width) {
    for (int bands = 1; bands <= kMostBands; ++bands) {
      const std::vector<int> edges = evenEdges(width, bands, step);
      REQUIRE(edges.size() == static_cast<size_t>(bands) + 1);
      CHECK(edges.front() == 0);
      CHECK(edges.back() == width);
      CHECK(std::ranges::is_sorted(edges));
      for (const int edge : edges) CHECK((edge == width || edge % step == 0));
      // The empty ones are the last.
      for (size_t i = 1; i < edges.size(); ++i) CHECK((edges[i - 1] < edges[i] || edges[i] == width));
    }
  }
}

TEST_CASE("edges move to where bands take the same time, and stay there") {
  const int bands = GENERATE(2, 3, 4), step = seamStepPx(GENERATE(1, 4));
  // What a column costs: little at the left, much about three quarters.
  const auto costs = [](int column) { return column > 900 && column < 1000 ? 5.0 : 1.0; };
  const auto timesOf = [&](const std::vector<int>& edges) {
    std::vector<double> ms;
    for (size_t i = 0; i + 1 < edges.size(); ++i) {
      ms.push_back(0);
      for (int column = edges[i]; column < edges[i + 1]; ++column) ms.back() += costs(column);
    }
    return ms;
  };
  std::vector<int> edges = evenEdges(1280, bands, step);
  const auto uneven = [&] {
    const std::vector<double> ms = timesOf(edges);
    return *std::ranges::max_element(ms) * bands / std::accumulate(ms.begin(), ms.end(), 0.0);
  };
  CHECK(uneven() > 1.2);
  for (int frame = 0; frame < 60; ++frame) {
    edges = balancedEdges(edges, timesOf(edges), step);
    CHECK(edges.front() == 0);
    CHECK(edges.back() == 1280);
    for (size_t i = 1; i < edges.size(); ++i) CHECK(edges[i - 1] < edges[i]);
    for (const int edge : edges) CHECK(edge % step == 0);
  }
  CHECK(uneven() < (step == 8 ? 1.1 : 1.3));
  const std::vector<int> settled = edges;
  for (int frame = 0; frame < 10; ++frame) edges = balancedEdges(edges, timesOf(edges), step);
  CHECK(edges == settled);
}

TEST_CASE("no band loses its last columns, wherever the work is") {
  const int step = GENERATE(8, 64), width = GENERATE(256, 800, 1283);
  for (const std::vector<double>& ms : {std::vector<double>{1000, 0, 0, 0}, {0, 0, 0, 1000}, {0, 1000, 0, 0}}) {
    std::vector<int> edges = evenEdges(width, 4, step);
    for (int frame = 0; frame < 200; ++frame) {
      edges = balancedEdges(edges, ms, step);
      for (size_t i = 0; i < 3; ++i) REQUIRE(edges[i + 1] - edges[i] >= step);
      REQUIRE(edges[4] > edges[3]);
      REQUIRE(edges[4] == width);
    }
  }
}

TEST_CASE("times that say nothing move no edge") {
  const std::vector<int> edges = evenEdges(800, 4, 8);
  CHECK(balancedEdges(edges, std::vector<double>{0, 0, 0, 0}, 8) == edges);
}

TEST_CASE("a box is drawn in every band in which a point of it shows, and in few others") {
  const Camera camera({0, 200, 416, 600, 800}, GENERATE(1.0f, -1.0f));
  const BandTest test(camera.edgesPx, camera.clipX, camera.clipW);
  std::mt19937 random(11);
  const auto uniform = [&](float low, float high) { return std::uniform_real_distribution(low, high)(random); };
  const auto direction = [&] { return glm::normalize(glm::vec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1))); };
  int shown = 0, spared = 0, needless = 0;
  for (int round = 0; round < 20000; ++round) {
    shader::CullBox box{};
    box.centre_ecef = glm::vec3(uniform(-50, 1000), uniform(-900, 900), uniform(-50, 50));
    const float sizeM = std::exp(uniform(std::log(0.1f), std::log(200.0f)));
    box.x_ecef = direction() * sizeM;
    box.y_ecef = glm::normalize(glm::cross(box.x_ecef, direction())) * sizeM * uniform(0.01f, 1);
    box.z_ecef = glm::normalize(glm::cross(box.x_ecef, box.y_ecef)) * sizeM * uniform(0.01f, 1);
    const float marginM = round % 2 == 0 ? 0.0f : uniform(0, 20);
    const uint32_t bands = test.bandsOf(box, marginM);
    uint32_t seen = 0;
    bool isBefore = true;
    for (int point = 0; point < 64; ++point) {
      const glm::vec3 at = glm::vec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
      const glm::vec3 p = box.centre_ecef + at.x * box.x_ecef + at.y * box.y_ecef + at.z * box.z_ecef +
                          uniform(0, marginM) * direction();
      isBefore &= p.x > 0;
      if (p.x > 0) seen |= camera.bandOf(camera.columnPx(p));
    }
    REQUIRE((bands & seen) == seen);
    if (!isBefore || seen == 0) continue;
    ++shown;
    spared += bands != 15u;
    needless += std::popcount(bands) > std::popcount(seen);
  }
  CAPTURE(shown, spared, needless);
  CHECK(shown > 10000);
  CHECK(spared > shown / 2);
  CHECK(needless < shown / 10);
}

TEST_CASE("one band has every box") {
  const Camera camera({0, 800}, 1);
  const BandTest test(camera.edgesPx, camera.clipX, camera.clipW);
  shader::CullBox behind{};
  behind.centre_ecef = glm::vec3(-1000, 0, 0);
  CHECK(test.bandsOf(behind) == 1);
}

TEST_CASE("no pixel depends on how many bands draw it") {
  struct Case {
    int widthPx, heightPx, samples;
  };
  const Case made = GENERATE(Case{201, 150, 1}, Case{201, 150, 4}, Case{20, 41, 1}, Case{7, 5, 1}, Case{640, 33, 1});
  CAPTURE(made.widthPx, made.heightPx, made.samples);
  std::vector<std::unique_ptr<Renderer>> renderers;
  std::vector<std::vector<ChunkDraw>> draws;
  for (int bands = 1; bands <= kMostBands; ++bands) {
    RendererOptions options;
    options.widthPx = made.widthPx;
    options.heightPx = made.heightPx;
    options.samples = made.samples;
    options.cullBy = CullBy::host;
    options.bands = bands;
    options.validate = bands == 3;
    renderers.push_back(makeRenderer(options));
    if (!renderers.back()) return;
    draws.push_back(mountains(*renderers.back(), 7, ecefFromGeodetic({49, 20, 2500})));
    for (ChunkDraw& chunk : draws.back()) {
      chunk.skirtMask = 15;
      chunk.skirtDepthM = {200, 200, 200, 200};
    }
  }
  std::mt19937 random(5);
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  uint64_t occluded = 0;
  for (int round = 0; round < 12; ++round) {
    const double lat = uniform(48.95, 49.05), lon = uniform(19.93, 20.07);
    const Pose pose{
        {lat, lon, ridgesM(lat, lon) + uniform(10, 800)}, uniform(0, 360), uniform(-40, 10), uniform(-60, 60)};
    for (int frame = 0; frame < 4; ++frame) {
      INFO("pose " << round << ", frame " << frame);
      std::optional<Picture> whole;
      for (size_t i = 0; i < renderers.size(); ++i) {
        INFO(i + 1 << " bands");
        FrameInput input = lookFrom(pose, made.widthPx, made.heightPx, 70);
        input.draws = draws[i];
        if (round % 3 == 2) input.view.frustum = {0.4, -0.7, -0.5, 0.5, 1};  // mirrored, and to one side
        if (frame > 0) input.depthMapPx = glm::ivec2(64, 48);
        const Picture picture = draw(*renderers[i], input);
        if (!whole) whole = picture;
        CHECK((picture == *whole));
        CHECK(picture.triangles == whole->triangles);
        CHECK(picture.clusters.drawn == whole->clusters.drawn);
        CHECK(picture.clusters.occluded == whole->clusters.occluded);
        occluded += picture.clusters.occluded;
      }
    }
  }
  if (made.widthPx > 100) CHECK(occluded > 300);  // else nothing was tested
  for (const auto& renderer : renderers) CHECK(renderer->validationMessages() == 0);
}

TEST_CASE("bands share the work: what shows in one alone is not drawn in another") {
  RendererOptions options;
  options.widthPx = 640;
  options.heightPx = 200;
  options.cullBy = CullBy::host;
  options.bands = 4;
  const auto renderer = makeRenderer(options);
  if (!renderer) return;
  const std::vector<ChunkDraw> draws = mountains(*renderer, 9, ecefFromGeodetic({49, 20, 2500}));
  FrameInput input = lookFrom({{48.9, 20, 2600}, 0, -10, 0}, options.widthPx, options.heightPx, 90);
  input.draws = draws;
  input.depthMapPx = glm::ivec2(160, 50);
  for (int frame = 0; frame < 3; ++frame) draw(*renderer, input);
  const CullReadBack culling = renderer->readCulling();
  if (culling.bands.size() == 1) {
    WARN("this device draws a picture as a whole");
    return;
  }
  REQUIRE(culling.bands.size() == 4);
  uint64_t inBands = 0, inWhole = 0;
  for (const CullReadBack::BandDraws& band : culling.bands) {
    uint64_t indices = 0;
    for (const shader::DrawCommand& command : band.early) indices += command.indexCount;
    CHECK(indices > 0);
    inBands += indices;
  }
  // Of a still eye what is drawn early is what shows.
  for (size_t i = 0; i < culling.fates.size(); ++i)
    if ((culling.fates[i] & EYE_FATE_EARLY) != 0)
      inWhole += 3 * static_cast<uint64_t>(std::popcount(culling.visibleTriangles[culling.candidates[i].cluster]));
  CAPTURE(inBands, inWhole);
  CHECK(inBands >= inWhole);
  CHECK(static_cast<double>(inBands) < 1.5 * static_cast<double>(inWhole));  // clusters on seams are drawn twice
}

TEST_CASE("what the first device does for the whole picture moves no seam") {
  RendererOptions options;
  options.widthPx = 640;
  options.heightPx = 200;
  options.cullBy = CullBy::host;
  options.bands = 2;
  const auto renderer = makeRenderer(options);
  if (!renderer) return;
  const std::vector<ChunkDraw> draws = mountains(*renderer, 9, ecefFromGeodetic({49, 20, 2500}));
  FrameInput input = lookFrom({{48.9, 20, 2600}, 0, -10, 0}, options.widthPx, options.heightPx, 90);
  input.draws = draws;  // colour and depth are read back in every frame
  if (GENERATE(false, true)) input.depthMapPx = glm::ivec2(160, 50);
  for (int frame = 0; frame < 150; ++frame) draw(*renderer, input);
  const std::vector<int> edges = renderer->readCulling().edgesPx;
  if (edges.size() == 2) return;
  REQUIRE(edges.size() == 3);
  CHECK(edges[1] > 180);  // near the middle in this view
  CHECK(edges[1] < 500);
}

TEST_CASE("a tinted picture has its sky in every band") {
  const Tint tint = GENERATE(Tint::level, Tint::fate);
  std::vector<Picture> pictures;
  for (const int bands : {1, 3}) {
    RendererOptions options;
    options.widthPx = 320;
    options.heightPx = 200;
    options.cullBy = CullBy::host;
    options.bands = bands;
    options.debugViews = true;
    const auto renderer = makeRenderer(options);
    if (!renderer) return;
    const std::vector<ChunkDraw> draws = mountains(*renderer, 5, ecefFromGeodetic({49, 20, 2500}));
    FrameInput input = lookFrom({{48.9, 20, 2600}, 0, 0, 0}, options.widthPx, options.heightPx, 90);
    input.draws = draws;
    input.depthMapPx = glm::ivec2(160, 50);
    input.tint = tint;
    input.hidesBelowHorizon = true;
    for (int frame = 0; frame < 3; ++frame) {
      pictures.push_back(draw(*renderer, input));
      input.showDepthMap = frame == 1;
    }
  }
  for (size_t frame = 0; frame < 3; ++frame) CHECK((pictures[frame] == pictures[frame + 3]));
}
