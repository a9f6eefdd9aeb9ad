// Whole pictures: no NaN, no validation message, from below the sea to far in space.
#include <catch2/catch.hpp>

#include <fmt/format.h>
#include <imgui.h>

#include "geo/sun.h"
#include "render/picture.h"
#include "render/scene.h"
#include "render/star_field.h"

using namespace eye;
using namespace eye::test;

TEST_CASE("mountains under a sky, validation clean") {
  RendererOptions options;
  options.validate = true;
  const auto renderer = makeRenderer(options);
  if (!renderer) return;
  const Pose pose{{49.0 - 0.2, 20.0, 3000}, 0, -8, 0};
  FrameInput input = lookFrom(pose, 800, 600);
  const std::vector<ChunkDraw> draws = mountains(*renderer, 13, input.view.eyeEcefM);
  input.draws = draws;
  const auto frame = renderer->drawFrame(input);
  REQUIRE(frame.has_value());
  CHECK(frame->rgba.size() == 800u * 600u * 4u);
  CHECK(renderer->validationMessages() == 0);
  keepPicture(*frame, "mountains");
  for (const PassTime& pass : frame->passes) INFO(pass.name << " " << pass.ms);
}

TEST_CASE("the sun's height sets the light") {
  const auto renderer = makeRenderer({});
  if (!renderer) return;
  const Pose pose{{49.0 - 0.2, 20.0, 3000}, 0, -8, 0};
  const std::vector<ChunkDraw> draws = mountains(*renderer, 13, ecefFromGeodetic(pose.position));
  const auto looked = [&](double elevationDeg, double visibilityM, const std::string& name) {
    FrameInput input = lookFrom(pose, 800, 600);
    input.draws = draws;
    const double elevation = radFromDeg(elevationDeg), azimuth = radFromDeg(20);
    const Vec3d sunEnu(std::cos(elevation) * std::sin(azimuth), std::cos(elevation) * std::cos(azimuth),
                       std::sin(elevation));
    input.lighting.sunDirectionEcef = ecefFromEnu(49.0, 20.0) * sunEnu;
    input.lighting.visibilityM = visibilityM;
    const auto frame = renderer->drawFrame(input);
    REQUIRE(frame.has_value());
    keepPicture(*frame, name);
    std::array<double, 4> mean{};  // red and blue of the upper sky, red and blue of the ground
    for (size_t i = 0; i < 800 * 60; ++i) {
      const size_t top = 4 * i, bottom = frame->rgba.size() - 4 * (i + 1);
      mean[0] += frame->rgba[top] / 48000.0;
      mean[1] += frame->rgba[top + 2] / 48000.0;
      mean[2] += frame->rgba[bottom] / 48000.0;
      mean[3] += frame->rgba[bottom + 2] / 48000.0;
    }
    return mean;
  };
  const auto noon = looked(50, 50000, "noon");
  const auto sunset = looked(2, 50000, "sunset");
  const auto night = looked(-30, 50000, "night");
  const auto fog = looked(50, 800, "fog");
  CHECK(noon[1] > 1.5 * noon[0]);                    // a blue sky
  CHECK(sunset[0] / sunset[1] > noon[0] / noon[1]);  // a warmer one
  CHECK(night[1] < 40);                              // a dark one
  CHECK(night[2] > 4);                               // but the ground is not quite black
  CHECK(noon[2] > 4 * night[2]);
  CHECK(std::abs(fog[0] - fog[2]) < 25);  // in fog, ground and sky are one
}

TEST_CASE("pictures from under the sea to far in space have no holes and no sparks") {
  RendererOptions options;
  options.widthPx = 320;
  options.heightPx = 240;
  options.validate = true;
  const auto renderer = makeRenderer(options);
  if (!renderer) return;
  std::vector<ChunkDraw> draws;
  for (int south = -88; south < 88; south += 22) {
    for (int west = -180; west < 180; west += 30) {
      const Patch patch{double(south), double(west), double(south + 22), double(west + 30), 24, 128};
      const auto seaLevel = [](double, double) { return 0.0; };
      const auto colour = static_cast<uint8_t>(80 + (south + west) % 40);
      draws.push_back(addChunk(*renderer, makeChunk(patch, seaLevel, flatTexture(128, colour, 110, 70))));
    }
  }
  std::vector<uint8_t> before;  // the picture of the height before
  for (const double altM : {-400.0, 2.0, 1000.0, 12000.0, 59999.0, 60001.0, 400e3, 3000e3, 62763e3}) {
    const double fovDeg = altM > 2e7 ? 15 : 60;
    const double pitchDeg =
        altM > 1e6 ? -90 : -degFromRad(std::acos(kSemiMajorM / (kSemiMajorM + std::max(altM, 0.0))));
    FrameInput input = lookFrom({{20, 30, altM}, 0, pitchDeg, 0}, 320, 240, fovDeg);
    input.draws = draws;
    const auto frame = renderer->drawFrame(input);
    REQUIRE(frame.has_value());
    keepPicture(*frame, fmt::format("height_{:.0f}", altM));
    // A NaN is written as black: no black pixel between two that are not, left and right of it.
    size_t sparks = 0;
    for (size_t i = 4; i + 8 < frame->rgba.size(); i += 4) {
      const auto sum = [&](size_t at) { return frame->rgba[at] + frame->rgba[at + 1] + frame->rgba[at + 2]; };
      sparks += sum(i) < 6 && sum(i - 4) > 60 && sum(i + 4) > 60;
    }
    INFO(altM << " m");
    CHECK(sparks == 0);
    // Where the air ends for the shaders, two metres change nothing.
    if (altM == 60001.0) {
      REQUIRE(before.size() == frame->rgba.size());
      int greatest = 0;
      for (size_t i = 0; i < before.size(); ++i) greatest = std::max(greatest, std::abs(before[i] - frame->rgba[i]));
      CHECK(greatest <= 3);
    }
    before.assign(frame->rgba.begin(), frame->rgba.end());
    if (altM > 2e7) CHECK(frame->rgba[0] + frame->rgba[1] + frame->rgba[2] < 12);  // space is black
    if (altM < 20000) CHECK(frame->rgba[2] > 60);
  }
  CHECK(renderer->validationMessages() == 0);
}

TEST_CASE("seen from space one half of the globe is lit, where the sun says so") {
  RendererOptions options;
  options.widthPx = options.heightPx = 240;
  const auto renderer = makeRenderer(options);
  if (!renderer) return;
  std::vector<ChunkDraw> draws;
  for (int south = -80; south < 80; south += 20) {
    for (int west = -180; west < 180; west += 20) {
      const Patch patch{double(south), double(west), double(south + 20), double(west + 20), 24, 128};
      draws.push_back(
          addChunk(*renderer, makeChunk(
                                  patch, [](double, double) { return 0.0; }, flatTexture(128, 120, 120, 120))));
    }
  }
  const Pose pose{{0, 30, 20e6}, 0, -90, 0};
  FrameInput input = lookFrom(pose, 240, 240, 40);
  input.draws = draws;
  // Noon at Greenwich on midsummer's day; then three hours before midnight.
  for (const double hoursUtc : {12.0, 21.0}) {
    const double jd = julianDay(2026, 6, 21 + hoursUtc / 24);
    input.lighting.sunDirectionEcef = sunDirectionEcef(jd);
    input.lighting.siderealRad = siderealRad(jd);
    const auto frame = renderer->drawFrame(input);
    REQUIRE(frame.has_value());
    keepPicture(*frame, fmt::format("terminator_{:.0f}", hoursUtc));
    size_t lit = 0, dark = 0;
    for (double latDeg = -50; latDeg <= 50; latDeg += 10) {
      for (double lonDeg = -20; lonDeg <= 80; lonDeg += 10) {
        const Vec3d place = ecefFromGeodetic({latDeg, lonDeg, 0});
        const Vec3d seen = input.view.eyeFromEcef * (place - input.view.eyeEcefM);
        const auto pixelOf = [&](double tan) {
          return static_cast<size_t>((tan / input.view.frustum.tanRight + 1) * 120);
        };
        const size_t at = 4 * (pixelOf(seen.y / seen.z) * 240 + pixelOf(seen.x / seen.z));
        const int green = frame->rgba[at + 1];
        const double sunHeight = glm::dot(upAt(latDeg, lonDeg), input.lighting.sunDirectionEcef);
        INFO(latDeg << " N " << lonDeg << " E, sine of the sun's height " << sunHeight << ", green " << green);
        if (sunHeight > 0.25) {
          CHECK(green > 70);
          ++lit;
        } else if (sunHeight < -0.3) {
          CHECK(green < 45);
          ++dark;
        }
      }
    }
    CHECK(lit + dark > 50);
    CHECK((hoursUtc == 12.0 ? lit : dark) > 20);
  }
}

TEST_CASE("stars: beyond the Earth and by night, where they belong; by day the sky is as it was") {
  RendererOptions options;
  options.widthPx = options.heightPx = 240;
  options.validate = true;
  const auto renderer = makeRenderer(options);
  if (!renderer) return;
  const auto look = [&](const Pose& pose, const Vec3d& sunEcef, const std::string& name) {
    FrameInput input = lookFrom(pose, 240, 240, 60);
    input.lighting.sunDirectionEcef = sunEcef;
    const auto frame = renderer->drawFrame(input);
    REQUIRE(frame.has_value());
    keepPicture(*frame, name);
    std::vector<StarInstance> placed;
    placeStars(input, placed);
    size_t found = 0;
    for (const StarInstance& star : placed) {
      if (star.brightness < 0.4f) continue;
      const auto x = static_cast<size_t>((star.ndc.x + 1) * 120), y = static_cast<size_t>((star.ndc.y + 1) * 120);
      const size_t at = 4 * (std::min<size_t>(y, 239) * 240 + std::min<size_t>(x, 239));
      found += frame->rgba[at + 1] > 40;
    }
    return std::pair(found, placed.size());
  };
  const Pose up{{10, 30, 100}, 0, 60, 0}, space{{10, 30, 400e3}, 0, 40, 0};
  const Vec3d overhead = upAt(10, 30);
  const auto night = look(up, -overhead, "stars_night"), day = look(up, overhead, "stars_day");
  CHECK(night.first > 3);
  CHECK(night.second > 100);
  CHECK(day.second == 0);                                    // none is drawn: the day's sky costs and shows what it did
  const auto beyond = look(space, overhead, "stars_space");  // the sun behind, the Earth below the picture
  CHECK(beyond.first > 3);
  CHECK(renderer->validationMessages() == 0);
}

TEST_CASE("stars stand still in the sky while the Earth turns, Polaris over the pole") {
  const auto nearest = [](const Vec3d& ecef, double siderealTurn) {
    double best = -1;
    Vec3d found{};
    for (const Star& star : stars()) {
      const Vec3d& d = star.direction;
      const Vec3d turned(std::cos(siderealTurn) * d.x + std::sin(siderealTurn) * d.y,
                         std::cos(siderealTurn) * d.y - std::sin(siderealTurn) * d.x, d.z);
      if (star.brightness > 0.4f && glm::dot(turned, ecef) > best) best = glm::dot(turned, ecef), found = turned;
    }
    return std::pair(degFromRad(std::acos(std::min(best, 1.0))), found);
  };
  CHECK(nearest({0, 0, 1}, 1.0).first < 1);
  // Sirius culminates when the sidereal time is its right ascension, 6 h 45 m: in the meridian, at its declination.
  const double turn = 6.752 / 12 * 3.14159265358979;
  CHECK(nearest(upAt(-16.72, 0), turn).first < 0.1);
  // Four minutes earlier every day: after a day of the sun the stars are a degree ahead.
  CHECK(degFromRad(std::remainder(siderealRad(2460001.0) - siderealRad(2460000.0), 6.283185307179586)) ==
        Approx(0.9856).margin(1e-3));
}

TEST_CASE("neither seams nor far mip levels show where textures meet") {
  RendererOptions options;
  options.widthPx = 320;
  options.heightPx = 240;
  const auto renderer = makeRenderer(options);
  if (!renderer) return;
  // Green in the levels that this view needs, red in the coarse ones.
  std::vector<uint8_t> texels = flatTexture(128, 60, 120, 60);
  const size_t fine = (128 * 128 + 64 * 64 + 32 * 32) * 4;
  for (size_t i = fine; i < texels.size(); i += 4) texels[i] = 255;
  std::vector<ChunkDraw> draws;
  for (int column = 0; column < 4; ++column) {
    const double west = 20 + 0.01 * column;
    draws.push_back(
        addChunk(*renderer, makeChunk(
                                {49, west, 49.01, west + 0.01}, [](double, double) { return 500.0; }, texels)));
  }
  FrameInput input = lookFrom({{49.005, 20.02, 1500}, 30, -88, 0}, 320, 240, 40);
  input.draws = draws;
  input.background = glm::vec3(0);
  const auto frame = renderer->drawFrame(input);
  REQUIRE(frame.has_value());
  keepPicture(*frame, "seams");
  const uint8_t* middle = &frame->rgba[(120 * 320 + 160) * 4];
  size_t ground = 0, odd = 0;
  for (size_t i = 0; i < frame->rgba.size(); i += 4) {
    if (frame->depth[i / 4] <= 0) continue;
    ++ground;
    for (size_t c = 0; c < 3; ++c) odd += std::abs(frame->rgba[i + c] - middle[c]) > 3;
  }
  CHECK(ground > 30000);
  CHECK(odd == 0);
  CHECK(middle[1] > middle[0] + 20);
}

TEST_CASE("the overlay shows off-screen") {
  RendererOptions options;
  options.widthPx = 320;
  options.heightPx = 240;
  options.validate = true;
  const auto renderer = makeRenderer(options);
  if (!renderer) return;
  FrameInput input = lookFrom({{49, 20, 3000}, 0, 20, 0}, 320, 240);
  const auto plain = renderer->drawFrame(input);
  REQUIRE(plain.has_value());
  const std::vector<uint8_t> before(plain->rgba.begin(), plain->rgba.end());
  const auto again = renderer->drawFrame(input);
  REQUIRE(again.has_value());
  CHECK(std::equal(before.begin(), before.end(), again->rgba.begin()));  // a still eye sees a still picture
  bool built = false;
  input.overlay = [&built] {
    ImGui::SetNextWindowPos({10, 10});
    ImGui::Begin("statistics");
    ImGui::TextUnformatted("16.7 ms");
    ImGui::End();
    built = true;
  };
  REQUIRE(renderer->drawFrame(input).has_value());  // windows fade in: the first frame only measures them
  const auto shown = renderer->drawFrame(input);
  REQUIRE(shown.has_value());
  keepPicture(*shown, "overlay");
  CHECK(built);
  size_t changed = 0;
  for (size_t i = 0; i < before.size(); i += 4) changed += std::abs(before[i + 2] - shown->rgba[i + 2]) > 8;
  CHECK(changed > 500);
  CHECK(changed < 320 * 240 / 2);
  CHECK(std::any_of(shown->passes.begin(), shown->passes.end(),
                    [](const PassTime& p) { return std::string(p.name) == "overlay"; }));
  CHECK(renderer->validationMessages() == 0);
}
