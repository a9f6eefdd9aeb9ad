// Triangles one by one: what is called hidden covers no pixel that it would change, by doubles at every pixel's
// samples.
#include <catch2/catch.hpp>

#include <random>

#include "render/triangle_cull.h"

using namespace eye;

namespace {

constexpr int kWide = 96, kHigh = 64;
constexpr float kNearM = 0.5f;

// Looks along z, x to the right, y down: 90 degrees across. Mirrored: x to the left.
shader::CullParams looking(bool isMirrored) {
  shader::CullParams params{};
  params.clipX_ecef = {isMirrored ? -1 : 1, 0, 0};
  params.clipY_ecef = {0, 1.5f, 0};
  params.clipW_ecef = {0, 0, 1};
  params.nearM = kNearM;
  params.picturePx = {kWide, kHigh};
  return params;
}

using Triangle = std::array<ChunkVertex, 3>;

struct Random {
  std::mt19937 engine{3};
  double operator()(double low, double high) { return std::uniform_real_distribution(low, high)(engine); }
};

// Somewhere in or beside the picture, of any size and slope.
Triangle randomTriangle(Random& random) {
  Triangle triangle;
  const double z = std::exp(random(std::log(1.0), std::log(30'000.0)));
  const double reach = z * std::exp(random(std::log(0.003), std::log(1.0)));
  const glm::dvec3 middle(random(-1.1, 1.1) * z, random(-0.8, 0.8) * z, z);
  for (ChunkVertex& corner : triangle) {
    const auto near = [&](double value) {
      return static_cast<int16_t>(std::clamp(value + random(-reach, reach), -32767.0, 32767.0));
    };
    corner = {near(middle.x), near(middle.y), near(middle.z), 0, 0, 0, 0, 0};
  }
  return triangle;
}

// Nearest depth that the triangle has at any sample of a pixel, as doubles have it; 0 where it covers none.
double depthAt(const Triangle& triangle, const VertexFrame& frame, bool isMirrored, double xPx, double yPx) {
  // The ray through the sample meets the triangle where all three volumes with its sides have one sign.
  const glm::dvec3 ray((isMirrored ? -1 : 1) * (2 * xPx / kWide - 1), (2 * yPx / kHigh - 1) / 1.5, 1);
  std::array<glm::dvec3, 3> at;
  for (size_t i = 0; i < 3; ++i)
    at[i] = frame.originM + frame.stepM * glm::dvec3(triangle[i].x, triangle[i].y, triangle[i].z);
  const double a = glm::dot(ray, glm::cross(at[1], at[2])), b = glm::dot(ray, glm::cross(at[2], at[0])),
               c = glm::dot(ray, glm::cross(at[0], at[1]));
  // Seen from outside its corners go round counterclockwise, with y down.
  if (!(a < 0 && b < 0 && c < 0)) return 0;
  const double distanceM = glm::dot(at[0], glm::cross(at[1], at[2])) / (a + b + c);
  return distanceM > kNearM ? kNearM / distanceM : 0;
}

// Whether it would change the picture, at four samples a pixel or at centres.
bool shows(const Triangle& triangle, const VertexFrame& frame, const std::vector<float>& depth, bool isMirrored,
           bool atCentres) {
  const std::vector<glm::dvec2> samples =
      atCentres ? std::vector<glm::dvec2>{{0.5, 0.5}}
                : std::vector<glm::dvec2>{{0.375, 0.125}, {0.875, 0.375}, {0.125, 0.625}, {0.625, 0.875}};
  for (int y = 0; y < kHigh; ++y)
    for (int x = 0; x < kWide; ++x)
      for (const glm::dvec2& sample : samples)
        if (depthAt(triangle, frame, isMirrored, x + sample.x, y + sample.y) >
            depth[static_cast<size_t>(y * kWide + x)])
          return true;
  return false;
}

}  // namespace

TEST_CASE("no triangle is called hidden that changes a pixel, and most that change none are") {
  const bool atCentres = GENERATE(true, false), isMirrored = GENERATE(false, true);
  CAPTURE(atCentres, isMirrored);
  Random random;
  size_t hidden = 0, found = 0, visible = 0, occluded = 0;
  const shader::CullParams params = looking(isMirrored);
  const VertexFrame frame{.originM = {0.25, -0.125, 0.5}, .stepM = 1, .count = 3};
  for (int round = 0; round < 30; ++round) {
    // Sky, a wall, and ground that comes nearer towards the lower edge.
    const double wallM = std::exp(random(std::log(20.0), std::log(20'000.0)));
    std::vector<float> depth(kWide * kHigh, 0.0f);
    for (int y = 0; y < kHigh; ++y)
      for (int x = 0; x < kWide; ++x)
        if (y > 20 || x > 60)
          depth[static_cast<size_t>(y * kWide + x)] =
              static_cast<float>(kNearM / (wallM * (y > 40 ? 60.0 - 0.9 * y : 24) / 24));
    TriangleCull cull(params, depth, atCentres);
    for (int i = 0; i < 300; ++i) {
      const Triangle triangle = randomTriangle(random);
      cull.place(frame, triangle);
      const TriangleFates fates = cull.fatesOf(std::array<uint16_t, 3>{0, 1, 2});
      const bool changes = shows(triangle, frame, depth, isMirrored, atCentres);
      if (changes) {
        INFO("round " << round << ", triangle " << i);
        REQUIRE(fates.visible == 1);
      }
      visible += changes;
      hidden += !changes;
      found += !changes && fates.visible == 0;
      occluded += fates.occluded;
    }
  }
  CAPTURE(visible, hidden, found, occluded);
  CHECK(visible > 500);
  CHECK(occluded > 300);
  // Those that it takes for visible cover many pixels, or are seen from the edge.
  CHECK(static_cast<double>(found) > (atCentres ? 0.65 : 0.6) * static_cast<double>(hidden));
}

TEST_CASE("a cluster of more triangles than bits is taken for visible") {
  const std::vector<float> depth(kWide * kHigh, 1.0f);
  TriangleCull cull(looking(false), depth, true);
  cull.place({.originM = {0, 0, 100}, .count = 3}, std::array<ChunkVertex, 3>{});
  CHECK(cull.fatesOf(std::vector<uint16_t>(3 * 65)).visible == kAllTriangles);
  CHECK(cull.fatesOf(std::vector<uint16_t>(3 * 64)).visible == 0);  // without any extent
}
