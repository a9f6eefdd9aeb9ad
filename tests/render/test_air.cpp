// Haze and sky by vertex against the same by pixel.
#include <catch2/catch.hpp>

#include <random>

#include "render/haze_width.h"
#include "render/scene.h"
#include "render/sky_dome.h"

using namespace eye;
using namespace eye::test;

namespace {

// Both dither, by half a step either way before they are rounded.
constexpr int kDither = 1;

struct Difference {
  int greatest = 0;
  double mean = 0;
};

Difference differenceOf(std::span<const uint8_t> a, std::span<const uint8_t> b) {
  REQUIRE(a.size() == b.size());
  Difference difference;
  for (size_t i = 0; i < a.size(); ++i) {
    const int off = std::abs(int{a[i]} - int{b[i]});
    difference.greatest = std::max(difference.greatest, off);
    difference.mean += off / static_cast<double>(a.size());
  }
  return difference;
}

FrameInput lit(const Pose& pose, double sunElevationDeg, double sunAzimuthDeg, double visibilityM) {
  FrameInput input = lookFrom(pose, 320, 240);
  const double elevation = radFromDeg(sunElevationDeg), azimuth = radFromDeg(sunAzimuthDeg);
  const Vec3d sunEnu(std::cos(elevation) * std::sin(azimuth), std::cos(elevation) * std::cos(azimuth),
                     std::sin(elevation));
  input.lighting.sunDirectionEcef = ecefFromEnu(pose.position.latDeg, pose.position.lonDeg) * sunEnu;
  input.lighting.visibilityM = visibilityM;
  return input;
}

struct BothWays {
  std::unique_ptr<Renderer> byVertex, byPixel;
  explicit operator bool() const { return byVertex && byPixel; }
};

BothWays makeBoth() {
  RendererOptions options;
  options.widthPx = 320;
  options.heightPx = 240;
  options.validate = true;
  BothWays both;
  both.byVertex = makeRenderer(options);
  options.airByPixel = true;
  both.byPixel = makeRenderer(options);
  return both;
}

}  // namespace

TEST_CASE("haze by vertex is haze by pixel to a step of colour") {
  const BothWays both = makeBoth();
  if (!both) return;
  const Pose pose{{49.0 - 0.2, 20.0, 3000}, 0, -8, 0};
  const std::vector<ChunkDraw> byVertex = mountains(*both.byVertex, 13, ecefFromGeodetic(pose.position));
  const std::vector<ChunkDraw> byPixel = mountains(*both.byPixel, 13, ecefFromGeodetic(pose.position));
  for (const double visibilityM : {2000.0, 10000.0, 60000.0, 200000.0}) {
    for (const double sunDeg : {50.0, 10.0, 2.0, -20.0}) {
      FrameInput input = lit(pose, sunDeg, 10, visibilityM);
      input.draws = byVertex;
      const auto cheap = both.byVertex->drawFrame(input);
      input.draws = byPixel;
      const auto exact = both.byPixel->drawFrame(input);
      REQUIRE(cheap.has_value());
      REQUIRE(exact.has_value());
      CHECK(std::equal(cheap->rgba.begin(), cheap->rgba.end(), exact->rgba.begin()) == false);  // two ways indeed
      const Difference off = differenceOf(cheap->rgba, exact->rgba);
      INFO("visibility " << visibilityM << " m, sun at " << sunDeg << " degrees: at most " << off.greatest
                         << " steps, mean " << off.mean);
      CHECK(off.greatest <= 1 + kDither);
      CHECK(off.mean < 0.6);
    }
  }
  CHECK(both.byVertex->validationMessages() + both.byPixel->validationMessages() == 0);
}

TEST_CASE("the sky's dome is the sky by pixel to two steps of colour") {
  const BothWays both = makeBoth();
  if (!both) return;
  std::mt19937 random(7);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int i = 0; i < 60; ++i) {
    const Pose pose{{between(-90, 90), between(-180, 180), i % 3 == 0 ? between(0, kDomeTopM) : between(0, 3000)},
                    between(0, 360),
                    i % 4 == 0 ? between(-20, 90) : between(-10, 30),
                    between(-180, 180)};
    FrameInput input = lit(pose, between(-20, 80), pose.headingDeg + between(-40, 40), between(500, 100000));
    input.readDepth = true;
    const auto cheap = both.byVertex->drawFrame(input);
    const auto exact = both.byPixel->drawFrame(input);
    REQUIRE(cheap.has_value());
    REQUIRE(exact.has_value());
    const Difference off = differenceOf(cheap->rgba, exact->rgba);
    INFO(i << ": height " << pose.position.altM << ", pitch " << pose.pitchDeg << ": at most " << off.greatest
           << " steps, mean " << off.mean);
    CHECK(off.greatest <= 2 + kDither);
    CHECK(off.mean < 0.5);
  }
}

TEST_CASE("an edge too long, or unknown, has its haze by pixel") {
  shader::FrameData frame{};
  frame.sunLight.w = 5e-5f;
  frame.horizonGlow = {0.2f, 0.2f, 0.1f, 0};
  ChunkDraw draw;
  draw.box = {Vec3d(10000, 0, 0), {Vec3d(500, 0, 0), Vec3d(0, 500, 0), Vec3d(0, 0, 500)}};
  draw.longestEdgeM = 200;
  CHECK(hazeOf(draw, {}, frame) == HazeBy::vertex);
  draw.longestEdgeM = 20000;
  CHECK(hazeOf(draw, {}, frame) == HazeBy::pixel);
  CHECK(hazeOf(ChunkDraw{}, {}, frame) == HazeBy::pixel);
  draw.longestEdgeM = 200;
  frame.sunLight.w = 5e-3f;  // fog
  CHECK(hazeOf(draw, {}, frame) == HazeBy::pixel);
}

TEST_CASE("the dome's part holds every ray of the view") {
  std::mt19937 random(3);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  size_t parts = 0;
  for (int i = 0; i < 3000; ++i) {
    const Pose pose{{between(-90, 90), between(-180, 180), between(0, 9000)},
                    between(0, 360),
                    between(-90, 90),
                    between(-180, 180)};
    const double left = between(-80, 40), bottom = between(-80, 40);
    const Frustum frustum = offAxisFrustum(left, between(left + 1, 85), bottom, between(bottom + 1, 85), 1);
    const View view = makeView(pose, frustum, 320, 240);
    const Vec3d up = upAt(pose.position.latDeg, pose.position.lonDeg), ahead = domeAhead(up);
    const double lowestRad = i % 2 == 0 ? domeRingRad(0) : between(-0.3, 0);
    const DomePart part = domePart(view, up, ahead, lowestRad);
    parts += part.strips < EYE_DOME_MERIDIANS;
    for (int ray = 0; ray < 20; ++ray) {
      const Vec3d eye(between(frustum.tanLeft, frustum.tanRight), -between(frustum.tanBottom, frustum.tanTop), 1);
      const Vec3d direction = glm::normalize(glm::transpose(view.eyeFromEcef) * eye);
      const double elevation = std::asin(glm::dot(direction, up));
      if (elevation < lowestRad) continue;
      CHECK(domeRingRad(part.firstRing) <= elevation + 1e-9);
      CHECK(domeRingRad(part.firstRing + part.rings - 1) >= elevation - 1e-9);
      const double azimuth = std::atan2(glm::dot(direction, glm::cross(up, ahead)), glm::dot(direction, ahead));
      const double strip = std::floor(azimuth / (2 * 3.14159265358979 / EYE_DOME_MERIDIANS));
      const auto beyondFirst = static_cast<uint32_t>(strip + 2 * EYE_DOME_MERIDIANS - part.firstStrip);
      CHECK(beyondFirst % EYE_DOME_MERIDIANS < part.strips);
    }
  }
  CHECK(parts > 500);  // not all of them whole rounds
}

TEST_CASE("below the horizon that the dome ends at every ray meets the lowered ellipsoid") {
  std::mt19937 random(11);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  double farthest = 0;  // below the horizon that a ray needs to meet it, radians
  for (int i = 0; i < 4000; ++i) {
    const double depthM = i % 3 == 0 ? between(0, 300000) : between(-300, 500);
    const double heightM = -depthM + std::exp(between(std::log(11.0), std::log(20000.0)));
    const Geodetic place{between(-90, 90), between(-180, 180), heightM};
    const Vec3d up = upAt(place.latDeg, place.lonDeg), ahead = domeAhead(up);
    const double azimuth = between(0, 6.283), elevation = horizonRad(heightM, depthM);
    REQUIRE(elevation > -1.57);
    const double shrink = 1 - 1.0001 * depthM / 6356752.314245;
    const Vec3d axes = Vec3d(6378137, 6378137, 6356752.314245) * shrink;
    const auto meets = [&](double ray) {
      const Vec3d level = ahead * std::cos(azimuth) + glm::cross(up, ahead) * std::sin(azimuth);
      const Vec3d from = ecefFromGeodetic(place) / axes, to = (up * std::sin(ray) + level * std::cos(ray)) / axes;
      const double along = glm::dot(from, to);
      return along * along >= glm::dot(to, to) * (glm::dot(from, from) - 1);
    };
    INFO("height " << heightM << ", depth " << depthM << ", latitude " << place.latDeg);
    CHECK(meets(elevation));
    double above = elevation;
    while (meets(above)) above += 1e-4;
    if (depthM < 500) farthest = std::max(farthest, above - elevation);
  }
  CHECK(farthest < 0.01);  // and not much too low
  CHECK(horizonRad(-400, 400) < -1.57);
  CHECK(horizonRad(-500, 400) < -1.57);
}

TEST_CASE("where no sky is drawn and no terrain hides it the horizon's colour shows, and nothing of the last frame") {
  RendererOptions made;
  made.widthPx = made.heightPx = 64;
  made.samples = GENERATE(1, 4);
  const auto renderer = makeRenderer(made);
  if (!renderer) return;
  const Pose below{{49.0, 20.0, 300}, 0, -60, 0}, far{{49.0, 20.0, 300}, 180, 0, 0};
  const std::vector<ChunkDraw> draws = mountains(*renderer, 3, ecefFromGeodetic({49.1, 20.0, 2500}));
  for (const bool culls : {false, true}) {
    FrameInput input = lit(far, 40, 10, 60000);
    input.view = makeView(far, symmetricFrustum(60, 64, 64, 1), 64, 64);
    input.background = glm::vec3(1, 0, 1);
    REQUIRE(renderer->drawFrame(input).has_value());
    input = lit(below, 40, 10, 60000);
    input.view = makeView(below, symmetricFrustum(60, 64, 64, 1), 64, 64);
    input.draws = draws;
    if (culls) input.depthMapPx = glm::ivec2(32, 32);
    input.hidesBelowHorizon = true;
    const auto frame = renderer->drawFrame(input);
    REQUIRE(frame.has_value());
    size_t magenta = 0;
    for (size_t i = 0; i < frame->rgba.size(); i += 4) magenta += frame->rgba[i] > 250 && frame->rgba[i + 1] < 5;
    CHECK(magenta == 0);
    CHECK(frame->rgba[2] > 100);  // the horizon by day
  }
}

TEST_CASE("fog lies on the ground: from a height the sky over it is that of a clear day") {
  const BothWays both = makeBoth();
  if (!both) return;
  for (const double heightM : {100e3, 2000e3}) {
    const Pose pose{{49.0, 20.0, heightM}, 0, 30, 0};
    const auto foggy = both.byVertex->drawFrame(lit(pose, 40, 10, 300));
    REQUIRE(foggy.has_value());
    const std::vector<uint8_t> above(foggy->rgba.begin(),
                                     foggy->rgba.begin() + 4 * 320);  // the next frame has its place
    const auto clear = both.byVertex->drawFrame(lit(pose, 40, 10, 60000));
    REQUIRE(clear.has_value());
    INFO(heightM << " m");
    CHECK(differenceOf(above, std::span<const uint8_t>(clear->rgba).first(4 * 320)).greatest <= 12);
  }
}

TEST_CASE("in fog neither the horizon shows nor the sun, nor ground that is lit elsewhere") {
  const BothWays both = makeBoth();
  if (!both) return;
  // 3 km up the horizon is nearly two degrees below the level, where the sun that has set here still shines.
  const Pose pose{{49.0 - 0.2, 20.0, 3000}, 0, 0, 0};
  for (Renderer* renderer : {both.byVertex.get(), both.byPixel.get()}) {
    const std::vector<ChunkDraw> draws = mountains(*renderer, 13, ecefFromGeodetic(pose.position));
    for (const double sunDeg : {20.0, -1.0, -12.0}) {
      const auto steepest = [&](double visibilityM) {
        FrameInput input = lit(pose, sunDeg, 10, visibilityM);
        input.draws = draws;
        const auto frame = renderer->drawFrame(input);
        REQUIRE(frame.has_value());
        constexpr size_t kRow = 4 * 320;
        std::span<const uint8_t> rgba = frame->rgba;
        return differenceOf(rgba.first(rgba.size() - kRow), rgba.subspan(kRow)).greatest;
      };
      INFO("sun at " << sunDeg << " degrees");
      CHECK(steepest(150) <= 2 + kDither);
      CHECK(steepest(60000) > 10);
    }
  }
}
