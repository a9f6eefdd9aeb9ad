// Layers of cloud from below, within and above: the maths, and pictures.
#include <catch2/catch.hpp>

#include <fmt/format.h>

#include "render/cloud_faces.h"
#include "render/frame_data.h"
#include "render/picture.h"
#include "render/scene.h"

using namespace eye;
using namespace eye::test;
using Catch::Detail::Approx;

namespace {

constexpr int kWidthPx = 320, kHeightPx = 240;

CloudLayer layerAt(double baseM, double topM, double coverage) {
  return {.baseM = baseM, .topM = topM, .baseTransitionM = 50, .topTransitionM = 50, .coverage = coverage};
}

// Flat ground at sea level for 20 km about, and a cone of 900 m to the north.
const Geodetic kPeak{49.06, 20.0, 0};
double coneM(double latDeg, double lonDeg) {
  const double northM = (latDeg - kPeak.latDeg) * 111200, eastM = (lonDeg - kPeak.lonDeg) * 73000;
  return std::max(900 - 0.6 * std::hypot(northM, eastM), 0.0);
}

std::vector<ChunkDraw> plainWithPeak(Renderer& renderer) {
  std::vector<ChunkDraw> draws;
  for (const double south : {48.8, 49.0, 49.2})
    for (const double west : {19.7, 19.9, 20.1}) {
      const Patch patch{south, west, south + 0.2, west + 0.2, 40, 1};
      draws.push_back(addChunk(renderer, makeChunk(patch, coneM, flatTexture(128, 40, 120, 30))));
    }
  return draws;
}

struct Colour {
  int red = 0, green = 0, blue = 0;
};
Colour at(const FrameOutput& frame, int x, int y) {
  const size_t i = 4 * (static_cast<size_t>(y) * kWidthPx + static_cast<size_t>(x));
  return {frame.rgba[i], frame.rgba[i + 1], frame.rgba[i + 2]};
}
bool isGreen(const Colour& c) {
  return c.green > c.red + 15 && c.green > c.blue + 15;
}
bool isBlue(const Colour& c) {
  return c.blue > c.red + 40;
}

std::unique_ptr<Renderer> validated(int samples = 1) {
  RendererOptions options;
  options.widthPx = kWidthPx, options.heightPx = kHeightPx;
  options.validate = true;
  options.samples = samples;
  return makeRenderer(options);
}

Vec3d rayTo(const FrameInput& input, const Vec3d& pointEcefM) {
  return input.view.eyeFromEcef * glm::normalize(pointEcefM - input.view.eyeEcefM);
}

}  // namespace

TEST_CASE("clouds: rays meet a layer's face where it is, from 1 m off it and from space") {
  for (const double latDeg : {0.0, 49.0, -89.0}) {
    for (const double eyeM : {0.0, 499.0, 1002.0, 9000.0, 400e3, 4e7}) {
      const Pose pose{{latDeg, 20, eyeM}, 30, 0, 0};
      FrameInput input = lookFrom(pose, kWidthPx, kHeightPx);
      input.lighting.clouds[1] = layerAt(500, 1001, 1);
      const auto faces = cloudFaces(input, frameData(input));
      REQUIRE(faces.size() == 1);
      const double faceM = eyeM < 500 ? 500 : 1001;
      for (const double awayDeg : {0.0, 0.001, 0.02, 0.3}) {
        const Vec3d point = ecefFromGeodetic({latDeg + awayDeg, 20.0, faceM});
        const double truthM = glm::distance(point, input.view.eyeEcefM);
        const double rises = glm::dot(glm::normalize(point - input.view.eyeEcefM), upAt(latDeg + awayDeg, 20));
        if (eyeM > faceM && rises >= 0) continue;  // the ray comes out there: it has met the face before
        const double slope = std::abs(rises);
        const auto hit = shader::cloudHit(faces[0], glm::vec3(rayTo(input, point)));
        INFO("latitude " << latDeg << ", eye at " << eyeM << " m, " << awayDeg << " degrees away");
        // A ray's direction is a float, and the ellipsoid lies a centimetre beside the face: what that moves the hit by
        // grows with the slope's inverse.
        CHECK(hit.distance * faces[0].sunPart.w == Approx(truthM).epsilon(2e-6 / slope).margin(0.01 / slope));
        CHECK(hit.slope == Approx(slope).margin(0.006));  // the ellipsoid's normal is not the scaled sphere's
      }
    }
  }
  // From above a level ray, and one that misses the Earth, meet nothing; from below every ray does.
  FrameInput input = lookFrom({{49, 20, 3000}, 0, 0, 0}, kWidthPx, kHeightPx);
  input.lighting.clouds[0] = layerAt(500, 1000, 1);
  const auto above = cloudFaces(input, frameData(input));
  CHECK(shader::cloudHit(above[0], {0, 0, 1}).distance == 0.0f);
  CHECK(shader::cloudHit(above[0], {0, -1, 0}).distance == 0.0f);
  CHECK(shader::cloudHit(above[0], {0, 1, 0}).distance * above[0].sunPart.w == Approx(2000));
  input = lookFrom({{49, 20, 0}, 0, 0, 0}, kWidthPx, kHeightPx);
  input.lighting.clouds[0] = layerAt(500, 1000, 1);
  const auto below = cloudFaces(input, frameData(input));
  CHECK(shader::cloudHit(below[0], {0, -1, 0}).distance * below[0].sunPart.w == Approx(500));
  CHECK(shader::cloudHit(below[0], {0, 0, 1}).distance * below[0].sunPart.w == Approx(79.8e3).epsilon(0.01));
  CHECK(shader::cloudHit(below[0], {0, 1, 0}).distance * below[0].sunPart.w > 12e6);  // through the Earth
}

TEST_CASE("clouds: opacity is the coverage overhead and grows towards the horizon; an eye within sees no face") {
  FrameInput input = lookFrom({{49, 20, 100}, 0, 0, 0}, kWidthPx, kHeightPx);
  const auto facesFrom = [&](double altM) {
    FrameInput from = lookFrom({{49, 20, altM}, 0, 0, 0}, kWidthPx, kHeightPx);
    from.lighting.clouds = input.lighting.clouds;
    return cloudFaces(from, frameData(from));
  };
  for (const double coverage : {0.1, 0.5, 0.9}) {
    input.lighting.clouds[0] = layerAt(500, 800, coverage);
    const auto faces = facesFrom(100);
    REQUIRE(faces.size() == 1);
    CHECK(shader::cloudOpacity(faces[0].shape.z, 1) == Approx(coverage));
    CHECK(shader::cloudOpacity(faces[0].shape.z, 0.2f) > shader::cloudOpacity(faces[0].shape.z, 0.3f));
    CHECK(shader::cloudOpacity(faces[0].shape.z, 0) == shader::cloudOpacity(faces[0].shape.z, 0.1f));
  }
  CHECK(facesFrom(600).empty());
  CHECK(facesFrom(499.9)[0].shape.w < 0.01f);  // no jump at the face
  CHECK(facesFrom(800.1)[0].shape.w < 0.01f);
  CHECK(facesFrom(440)[0].shape.w == 1.0f);
  // Two layers: that behind first, from wherever the eye is.
  input.lighting.clouds[1] = layerAt(3000, 3100, 0.5);
  REQUIRE(facesFrom(0).size() == 2);
  CHECK(facesFrom(0)[0].sunPart.w > facesFrom(0)[1].sunPart.w);
  REQUIRE(facesFrom(5000).size() == 2);
  CHECK(facesFrom(5000)[0].sunPart.w < facesFrom(5000)[1].sunPart.w);
  CHECK(facesFrom(600).size() == 1);
  CHECK(sunThroughClouds({}, 0) == 1.0);
  CHECK(sunThroughClouds({layerAt(500, 800, 1)}, 0) < 0.2);
  CHECK(sunThroughClouds({layerAt(500, 800, 1)}, 900) == 1.0);
}

TEST_CASE(
    "clouds: an overcast hides sky and peak from below; from above it hides the ground, and the peak stands out") {
  for (const int samples : {1, 4}) {
    const auto renderer = validated(samples);
    if (!renderer) return;
    const std::vector<ChunkDraw> draws = plainWithPeak(*renderer);
    const auto look = [&](double altM, double pitchDeg, double coverage, const std::string& name) {
      FrameInput input = lookFrom({{49.0, 20.0, altM}, 0, pitchDeg, 0}, kWidthPx, kHeightPx);
      input.draws = draws;
      if (coverage > 0) input.lighting.clouds[0] = layerAt(500, 700, coverage);
      auto frame = renderer->drawFrame(input);
      REQUIRE(frame.has_value());
      keepPicture(*frame, fmt::format("cloud_{}_{}", name, samples));
      struct Kept {
        FrameOutput out;
        std::vector<uint8_t> rgba;
        std::vector<float> depth;
      } kept{*frame, {frame->rgba.begin(), frame->rgba.end()}, {frame->depth.begin(), frame->depth.end()}};
      return kept;
    };
    const auto pixel = [&](auto& kept, double elevationDeg, double pitchDeg) {
      kept.out.rgba = kept.rgba;
      const double perTan = kWidthPx / 2.0 / std::tan(radFromDeg(30));
      return at(kept.out, kWidthPx / 2,
                static_cast<int>(kHeightPx / 2.0 - perTan * std::tan(radFromDeg(elevationDeg - pitchDeg))));
    };
    // The peak is 6.7 km away: seen from 100 m its top stands 6.8 degrees up, the base of the clouds meets it at 3.4.
    auto bare = look(100, 10, 0, "below_without"), under = look(100, 10, 1, "below");
    CHECK(isGreen(pixel(bare, 5.5, 10)));
    CHECK_FALSE(isGreen(pixel(under, 5.5, 10)));
    CHECK(isGreen(pixel(under, 2.0, 10)));
    CHECK(isBlue(pixel(bare, 25, 10)));
    CHECK_FALSE(isBlue(pixel(under, 25, 10)));
    CHECK(pixel(under, 25, 10).red > 60);
    CHECK(bare.depth == under.depth);
    // From 1,500 m: the foot of the peak and the plain are hidden, its top is not.
    auto clear = look(1500, -8, 0, "above_without"), over = look(1500, -8, 1, "above");
    CHECK(isGreen(pixel(clear, -20, -8)));
    CHECK_FALSE(isGreen(pixel(over, -20, -8)));
    CHECK(pixel(over, -20, -8).red > 150);
    CHECK(isGreen(pixel(clear, -5.7, -8)));
    CHECK(isGreen(pixel(over, -5.7, -8)));
    CHECK(isGreen(pixel(clear, -8.5, -8)));
    CHECK_FALSE(isGreen(pixel(over, -8.5, -8)));
    CHECK(clear.depth == over.depth);
    // The sky above a deck is as it was.
    CHECK(std::equal(clear.rgba.begin(), clear.rgba.begin() + 4 * kWidthPx * 20, over.rgba.begin()));
    CHECK(renderer->validationMessages() == 0);
  }
}

TEST_CASE("clouds: without coverage, or from within, the picture is that without a layer, byte for byte") {
  const auto renderer = validated();
  if (!renderer) return;
  const std::vector<ChunkDraw> draws = plainWithPeak(*renderer);
  const auto look = [&](const CloudLayers& clouds, double altM, bool culls) {
    FrameInput input = lookFrom({{49.0, 20.0, altM}, 0, 0, 0}, kWidthPx, kHeightPx);
    input.draws = draws;
    input.lighting.clouds = clouds;
    if (culls) input.depthMapPx = glm::ivec2(64, 48);
    const auto frame = renderer->drawFrame(input);
    REQUIRE(frame.has_value());
    return std::vector<uint8_t>(frame->rgba.begin(), frame->rgba.end());
  };
  CHECK(look({layerAt(500, 700, 0)}, 100, false) == look({}, 100, false));
  CHECK(look({layerAt(500, 700, 0.5)}, 100, false) != look({}, 100, false));
  // The same with the clusters culled against a depth map.
  for (const double altM : {100.0, 1500.0}) {
    (void)look({layerAt(500, 700, 0.6)}, altM, true);
    CHECK(look({layerAt(500, 700, 0.6)}, altM, true) == look({layerAt(500, 700, 0.6)}, altM, false));
  }
  CHECK(renderer->validationMessages() == 0);
}

TEST_CASE("clouds: flying up through a layer nothing jumps, and a broken one covers about its share of the sky") {
  const auto renderer = validated();
  if (!renderer) return;
  const auto meanOf = [&](double altM, double pitchDeg, double coverage) {
    FrameInput input = lookFrom({{49.0, 20.0, altM}, 0, pitchDeg, 0}, kWidthPx, kHeightPx);
    if (coverage > 0) input.lighting.clouds[0] = layerAt(2000, 2300, coverage);
    const auto frame = renderer->drawFrame(input);
    REQUIRE(frame.has_value());
    double red = 0;
    for (size_t i = 0; i < frame->rgba.size(); i += 4) red += frame->rgba[i];
    return red / (kWidthPx * kHeightPx);
  };
  for (const double faceM : {2000.0, 2300.0}) {
    const double pitchDeg = faceM == 2000 ? 30 : -30;
    double before = meanOf(faceM - 60, pitchDeg, 1);
    for (double altM = faceM - 58; altM <= faceM + 60; altM += 2) {
      const double now = meanOf(altM, pitchDeg, 1);
      INFO(altM << " m: " << before << " to " << now);
      CHECK(std::abs(now - before) < 8);
      before = now;
    }
  }
  // Overhead, where a tenth more or less of the sky is a matter of place: means over several places.
  for (const double coverage : {0.25, 0.5, 0.75}) {
    double covered = 0;
    for (int i = 0; i < 12; ++i) {
      FrameInput input = lookFrom({{40.0 + 0.7 * i, 20.0 + i, 0}, 0, 90, 0}, kWidthPx, kHeightPx, 90);
      const auto blueness = [&](double share) {
        input.lighting.clouds[0] = layerAt(4000, 4300, share);
        const auto frame = renderer->drawFrame(input);
        REQUIRE(frame.has_value());
        double sum = 0;
        for (size_t p = 0; p < frame->rgba.size(); p += 4) sum += frame->rgba[p + 2] - frame->rgba[p];
        return sum;
      };
      const double bare = blueness(0), sheet = blueness(1);
      covered += (bare - blueness(coverage)) / (bare - sheet) / 12;
    }
    INFO("coverage " << coverage << " shows as " << covered);
    CHECK(covered > coverage - 0.15);
    CHECK(covered < coverage + 0.15);
  }
  CHECK(renderer->validationMessages() == 0);
}
