// Where things land on the screen: distances, facing, cracks, skirts.
#include <catch2/catch.hpp>

#include <random>

#include "render/scene.h"

using namespace eye;
using namespace eye::test;

namespace {

constexpr int kWidth = 160, kHeight = 120;
const glm::vec3 kMagenta(1, 0, 1);

RendererOptions smallOptions() {
  RendererOptions options;
  options.widthPx = kWidth;
  options.heightPx = kHeight;
  options.validate = true;
  return options;
}

FrameOutput draw(Renderer& renderer, const FrameInput& input) {
  auto frame = renderer.drawFrame(input);
  if (!frame) FAIL(frame.error().message);
  return *frame;
}

// A pixel counts as background when it is (nearly, for the dither) magenta; no ground here has red and blue without
// green.
size_t backgroundPixels(const FrameOutput& frame) {
  size_t count = 0;
  for (size_t i = 0; i < frame.rgba.size(); i += 4) {
    count += frame.rgba[i] > 250 && frame.rgba[i + 1] < 5 && frame.rgba[i + 2] > 250;
  }
  return count;
}

HeightFunction level(double heightM) {
  return [heightM](double, double) { return heightM; };
}

}  // namespace

TEST_CASE("depth is near over z of the triangles, and 0 where nothing is") {
  const auto renderer = makeRenderer(smallOptions());
  if (!renderer) return;
  const MadeChunk chunk = makeChunk({49, 20, 49.02, 20.03}, level(500), flatTexture(128, 90, 120, 60));
  const std::vector<ChunkDraw> draws{addChunk(*renderer, chunk)};
  const double nearM = GENERATE(0.5, 1.0, 25.0);
  const double altM = GENERATE(510.0, 900.0, 1800.0);
  const Pose pose{{49.003, 20.012, altM}, 20, altM > 1000 ? -70.0 : -30.0, 5};
  FrameInput input = lookFrom(pose, kWidth, kHeight, 60, nearM);
  input.draws = draws;
  const FrameOutput frame = draw(*renderer, input);

  size_t ground = 0, sky = 0;
  double worst = 0;
  const ChunkMesh& mesh = chunk.loaded.mesh;
  for (int row = 3; row < kHeight; row += 17) {
    for (int column = 3; column < kWidth; column += 23) {
      const Vec3d rayEye = rayThroughPixel(input.view.frustum, kWidth, kHeight, column, row);
      const Vec3d ray = glm::transpose(input.view.eyeFromEcef) * rayEye;  // z = 1, so its parameter is z
      double nearest = 0;
      for (size_t i = 0; i < chunk.loaded.surfaceIndexCount; i += 3) {  // Moeller and Trumbore
        std::array<Vec3d, 3> p;
        for (size_t k = 0; k < 3; ++k) {
          const ChunkVertex& v = mesh.vertices[mesh.indices[i + k]];
          p[k] = ecefFromLattice(chunk.origin + LatticePoint(v.x, v.y, v.z), 0.125) - input.view.eyeEcefM;
        }
        const Vec3d e1 = p[1] - p[0], e2 = p[2] - p[0], h = glm::cross(ray, e2);
        const double u = glm::dot(-p[0], h) / glm::dot(e1, h);
        const Vec3d q = glm::cross(-p[0], e1);
        const double v = glm::dot(ray, q) / glm::dot(e1, h);
        if (u < 0 || v < 0 || u + v > 1) continue;
        nearest = glm::dot(e2, q) / glm::dot(e1, h);
      }
      const float depth = frame.depth[static_cast<size_t>(row * kWidth + column)];
      if (nearest <= 0) {
        CHECK(depth == 0.0f);
        ++sky;
      } else if (depth > 0) {  // 0: a pixel whose centre is within a hair of the chunk's edge
        worst = std::max(worst, std::abs(nearM / static_cast<double>(depth) / nearest - 1));
        ++ground;
      }
    }
  }
  CHECK(ground > 10);
  CHECK(worst < 1e-4);
  CHECK(renderer->validationMessages() == 0);
}

TEST_CASE("a surface is seen from above and not from below") {
  const auto renderer = makeRenderer(smallOptions());
  if (!renderer) return;
  const MadeChunk chunk = makeChunk({49, 20, 49.02, 20.03}, level(500), flatTexture(128, 90, 120, 60));
  const std::vector<ChunkDraw> draws{addChunk(*renderer, chunk)};
  const auto covered = [&](double altM, double pitchDeg, double rollDeg) {
    FrameInput input = lookFrom({{49.01, 20.015, altM}, 0, pitchDeg, rollDeg}, kWidth, kHeight);
    input.draws = draws;
    const FrameOutput frame = draw(*renderer, input);
    return std::count_if(frame.depth.begin(), frame.depth.end(), [](float d) { return d > 0; });
  };
  CHECK(covered(700, -90, 0) == kWidth * kHeight);
  CHECK(covered(700, -90, 77) == kWidth * kHeight);
  CHECK(covered(300, 90, 0) == 0);
}

TEST_CASE("north is up, east is right") {
  const auto renderer = makeRenderer(smallOptions());
  if (!renderer) return;
  const MadeChunk east = makeChunk({49.00, 20.00, 49.01, 20.01}, level(500), flatTexture(128, 200, 20, 20));
  const MadeChunk north = makeChunk({49.01, 19.99, 49.02, 20.00}, level(500), flatTexture(128, 20, 200, 20));
  const std::vector<ChunkDraw> draws{addChunk(*renderer, east), addChunk(*renderer, north)};
  FrameInput input = lookFrom({{49.01, 20.00, 1000}, 0, -90, 0}, kWidth, kHeight);
  input.draws = draws;
  input.background = glm::vec3(0);
  const FrameOutput frame = draw(*renderer, input);
  const auto at = [&](int column, int row) { return &frame.rgba[static_cast<size_t>(row * kWidth + column) * 4]; };
  CHECK(at(kWidth - 20, kHeight - 20)[0] > 2 * at(kWidth - 20, kHeight - 20)[1]);  // south-east: red
  CHECK(at(20, 20)[1] > 2 * at(20, 20)[0]);                                        // north-west: green
  CHECK(int{at(20, kHeight - 20)[1]} == 0);
}

TEST_CASE("no background shows between two chunks of one level") {
  const auto renderer = makeRenderer(smallOptions());
  if (!renderer) return;
  const HeightFunction rough = [](double lat, double lon) {
    return 600 + 150 * std::sin(lat * 900) * std::cos(lon * 700);
  };
  std::vector<ChunkDraw> draws;
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 2; ++column) {
      const double south = 49 + 0.02 * row, west = 20 + 0.03 * column;
      draws.push_back(addChunk(
          *renderer, makeChunk({south, west, south + 0.02, west + 0.03}, rough, flatTexture(128, 90, 120, 60))));
    }
  }
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  size_t holes = 0;
  for (int i = 0; i < 200; ++i) {
    // Straight down on the corner where the four meet, from 5 m to 500 m above the highest ground.
    const double heightM = 755 + 5 * std::pow(100, unit(random));
    const Pose pose{{49.02 + 2e-4 * (unit(random) - 0.5), 20.03 + 2e-4 * (unit(random) - 0.5), heightM},
                    360 * unit(random),
                    -90 + 8 * unit(random),
                    0};
    FrameInput input = lookFrom(pose, kWidth, kHeight);
    input.draws = draws;
    input.background = kMagenta;
    holes += backgroundPixels(draw(*renderer, input));
  }
  CHECK(holes == 0);
}

TEST_CASE("a skirt closes the gap between edges of different height") {
  const auto renderer = makeRenderer(smallOptions());
  if (!renderer) return;
  // The western chunk's edge lies 6 m under the eastern one's, seen from the west looking at the wall.
  const MadeChunk west = makeChunk({49, 20.00, 49.02, 20.03}, level(500), flatTexture(128, 90, 120, 60));
  const MadeChunk east = makeChunk({49, 20.03, 49.02, 20.06}, level(506), flatTexture(128, 90, 120, 60));
  std::vector<ChunkDraw> draws{addChunk(*renderer, west), addChunk(*renderer, east)};
  // From above the edge, a little to the west: the gap is a band in the middle of the picture.
  FrameInput input = lookFrom({{49.01, 20.0299, 512}, 90, -35, 0}, kWidth, kHeight);
  input.background = kMagenta;
  input.draws = draws;
  CHECK(backgroundPixels(draw(*renderer, input)) > 50);
  for (ChunkDraw& chunk : draws) chunk.skirtDepthM.fill(8);
  draws[0].skirtMask = 1 << static_cast<int>(Side::east);
  draws[1].skirtMask = 1 << static_cast<int>(Side::west);
  const FrameOutput closed = draw(*renderer, input);
  CHECK(backgroundPixels(closed) == 0);
  CHECK(closed.draws == 4);
  // The upper one's alone reaches down to the lower ground.
  draws[0].skirtMask = 0;
  CHECK(backgroundPixels(draw(*renderer, input)) == 0);
  // Only the sides that are asked for: the wrong ones leave the gap open.
  draws[0].skirtMask = draws[1].skirtMask = 1 << static_cast<int>(Side::north);
  CHECK(backgroundPixels(draw(*renderer, input)) > 50);
}

TEST_CASE("an eye that moves by a millimetre moves the ground by a millimetre") {
  const auto renderer = makeRenderer(smallOptions());
  if (!renderer) return;
  const MadeChunk chunk = makeChunk({49, 20, 49.02, 20.03}, level(500), flatTexture(128, 90, 120, 60));
  const std::vector<ChunkDraw> draws{addChunk(*renderer, chunk)};
  double before = 0;
  for (int step = 0; step < 50; ++step) {
    FrameInput input = lookFrom({{49.0101, 20.0151, 510 + 0.001 * step}, 0, -90, 0}, kWidth, kHeight);
    input.draws = draws;
    const double distanceM = 1 / double{draw(*renderer, input).depth[kWidth * kHeight / 2 + kWidth / 2]};
    // Half a lattice step of slope under the pixel's ray changes nothing here; a float's digit at 10 m is a micrometre.
    if (step > 0) CHECK(distanceM - before == Approx(0.001).margin(2e-5));
    before = distanceM;
  }
}
