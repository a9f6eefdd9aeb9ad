// What the shaders are told, and the file that pipelines are kept in. No device needed.
#include <catch2/catch.hpp>

#include "gpu/pipeline_cache.h"
#include "render/frame_data.h"
#include "render/scene.h"

using namespace eye;
using namespace eye::test;

TEST_CASE("two chunks of one level give the same integers for a point that they share") {
  const Vec3d eyeEcefM = ecefFromGeodetic({49.1, 20.2, 812.345678});
  ChunkDraw a, b;
  a.stepM = b.stepM = 0.0625;
  const LatticePoint shared = latticeFromEcef(ecefFromGeodetic({49.11, 20.21, 700}), a.stepM);
  a.originLattice = shared - LatticePoint(1234, -77, 30000);
  b.originLattice = shared + LatticePoint(-31000, 5, -123);
  const shader::DrawData first = drawData(a, eyeEcefM, 128), second = drawData(b, eyeEcefM, 128);
  CHECK(first.originMinusEyeCell + glm::ivec3(1234, -77, 30000) ==
        second.originMinusEyeCell + glm::ivec3(31000, -5, 123));
  CHECK(first.eyeFractionM == second.eyeFractionM);
  // And the shader's sum, in floats, is the true position to a few micrometres at 1.3 km.
  const glm::vec3 seen =
      glm::vec3(first.originMinusEyeCell + glm::ivec3(1234, -77, 30000)) * first.stepM - first.eyeFractionM;
  CHECK(glm::distance(Vec3d(seen), ecefFromLattice(shared, a.stepM) - eyeEcefM) < 2e-4);
}

TEST_CASE("a chunk of the finest lattice seen from the Moon's distance does not overflow") {
  ChunkDraw draw;
  draw.stepM = 1.0 / 1024;
  draw.originLattice = latticeFromEcef(ecefFromGeodetic({0, 0, 0}), draw.stepM);
  const Vec3d eyeEcefM = ecefFromGeodetic({10, 20, 384e6});
  const shader::DrawData data = drawData(draw, eyeEcefM, 128);
  const Vec3d seen(glm::vec3(data.originMinusEyeCell) * data.stepM - data.eyeFractionM);
  const Vec3d truth = ecefFromGeodetic({0, 0, 0}) - eyeEcefM;
  CHECK(glm::distance(seen, truth) / glm::length(truth) < 1e-6);
}

// A known point of the ground, from 62,763 km down to 2 m, as the vertex shader computes it, against double precision.
TEST_CASE("on the way down from space a point stays where it is, and comes nearer without a jump") {
  const Vec3d ground = ecefFromGeodetic({36.63, 128.335, 30});
  FrameInput input;
  double beforePx = 0, beforeM = 1e9;
  for (double heightM = 62'763'000; heightM >= 2; heightM *= 0.9) {
    // Beside the point, so that it lies off the view's axis, three quarters of the way to the picture's rim.
    const Vec3d eye = ecefFromGeodetic({36.63, 128.335, 30 + heightM});
    const double side = 0.4 * heightM;
    input.view = makeView({geodeticFromEcef(eye + side * ecefFromEnu(36.63, 128.335)[0]), 0, -90, 0},
                          symmetricFrustum(60, 1024, 1024, 1), 1024, 1024);
    const shader::FrameData frame = frameData(input);
    const Vec3d truth = input.view.eyeFromEcef * (ground - input.view.eyeEcefM);
    const auto pixels = [&](double tan) { return (tan / input.view.frustum.tanRight + 1) * 512; };
    for (const double stepM : {16.0, 1.0, 1.0 / 64}) {
      ChunkDraw draw;
      draw.stepM = stepM;
      draw.originLattice = latticeFromEcef(ground, stepM);
      const shader::DrawData data = drawData(draw, input.view.eyeEcefM, 128);
      // What rounding to the lattice moved is the chunk's affair.
      const Vec3d lattice = input.view.eyeFromEcef * (ecefFromLattice(draw.originLattice, stepM) - input.view.eyeEcefM);
      const glm::vec3 relative = glm::vec3(data.originMinusEyeCell) * data.stepM - data.eyeFractionM;
      const glm::vec4 clip = frame.clipFromEcef * glm::vec4(relative, 1.0f);
      INFO(heightM << " m up, step " << stepM);
      CHECK(std::abs((clip.x / clip.w + 1) * 512 - pixels(lattice.x / lattice.z)) < 0.01);
      CHECK(std::abs((clip.y / clip.w + 1) * 512 - pixels(lattice.y / lattice.z)) < 0.01);
      CHECK(std::abs(double(clip.w) / lattice.z - 1) < 4e-6);
    }
    // The eye moves along one ray from the point: the picture of the point hardly moves from height to height.
    const double nowPx = pixels(truth.x / truth.z);
    if (heightM < 5e4 && beforePx > 0) CHECK(std::abs(nowPx - beforePx) < 1.5);
    CHECK(truth.z < beforeM);
    beforePx = nowPx;
    beforeM = truth.z;
  }
}

TEST_CASE("the outermost texels' centres lie on a chunk's edges, also through an ancestor's part") {
  ChunkDraw draw;
  const shader::DrawData own = drawData(draw, {}, 128);
  CHECK(own.textureOffset.x == Approx(0.5 / 128));
  CHECK(own.textureScale.y + own.textureOffset.y == Approx(127.5 / 128));
  draw.textureScale = glm::vec2(0.25f);
  draw.textureOffset = glm::vec2(0.5f, 0.75f);
  const shader::DrawData ancestors = drawData(draw, {}, 128);
  CHECK(ancestors.textureOffset.x == Approx(64.0 / 128));  // half way between the first and the last centre
  CHECK(ancestors.textureScale.y + ancestors.textureOffset.y == Approx(127.5 / 128));
}

TEST_CASE("clip space: corners of the frustum, depth near over z") {
  FrameInput input;
  const Frustum frustum = offAxisFrustum(-10, 40, -20, 30, 2);
  input.view = makeView({{30, 40, 5000}, 70, -10, 25}, frustum, 500, 500);
  const shader::FrameData frame = frameData(input);
  const auto ndc = [&](const Vec3d& eye) {
    const glm::vec4 clip = frame.clipFromEcef * glm::vec4(glm::vec3(glm::transpose(input.view.eyeFromEcef) * eye), 1);
    return glm::vec3(clip) / clip.w;
  };
  const double z = 1000;
  const glm::vec3 leftTop = ndc({frustum.tanLeft * z, -frustum.tanTop * z, z});
  const glm::vec3 rightBottom = ndc({frustum.tanRight * z, -frustum.tanBottom * z, z});
  CHECK(glm::distance(leftTop, glm::vec3(-1, -1, 0.002f)) < 1e-5f);
  CHECK(glm::distance(rightBottom, glm::vec3(1, 1, 0.002f)) < 1e-5f);
}

TEST_CASE("a damaged pipeline cache is ignored") {
  const std::vector<uint8_t> driverBytes{1, 2, 3, 4, 5};
  std::string file = packPipelineCache(driverBytes);
  CHECK(unpackPipelineCache(file) == driverBytes);
  for (size_t i = 0; i < file.size(); ++i) {
    std::string damaged = file;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x10);
    CHECK_FALSE(unpackPipelineCache(damaged).has_value());
    CHECK_FALSE(unpackPipelineCache(file.substr(0, i)).has_value());
  }
}
