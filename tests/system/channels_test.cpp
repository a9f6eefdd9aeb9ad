// Off-axis frusta and the two horizon tests, end to end: what the program draws with them is the same picture.
#include <catch2/catch.hpp>
#include <cmath>

#include "system/program.h"
#include "system/rasters.h"

namespace eye::truth {
namespace {

constexpr int kHeight = 200, kChannelWidth = 160, kChannels = 3;

RasterImage draw(const std::string& database, const std::string& name, int widthPx, const std::string& pose,
                 const std::vector<std::string>& more, int heightPx = kHeight) {
  const std::string map = testFile(name + ".tif");
  std::vector<std::string> words{
      "--headless",     "--offline", "--terrain",   database,
      "--pose",         pose,        "--size",      std::to_string(widthPx) + "x" + std::to_string(heightPx),
      "--distance-map", map,         "--log-level", "error"};
  words.insert(words.end(), more.begin(), more.end());
  const ProgramRun run = runProgram("eyepoint", words);
  INFO(joined(words) << ": " << run.err);
  REQUIRE(run.exitCode == 0);
  RasterImage image = readRaster(map);
  REQUIRE(image.widthPx == widthPx);
  REQUIRE(image.heightPx == heightPx);
  return image;
}

std::string frustum(double tanLeft, double tanRight, double tanUp) {
  const auto degrees = [](double tangent) { return std::to_string(std::atan(tangent) * 57.29577951308232); };
  return "--frustum=" + degrees(tanLeft) + "," + degrees(tanRight) + "," + degrees(-tanUp) + "," + degrees(tanUp);
}

}  // namespace

TEST_CASE("channels: three frusta side by side make the wide picture") {
  const std::string database = carpathiaDatabase();
  if (database.empty()) return;
  const std::string pose = "49.25,20.1,2600,180,-5,7";
  const double tanUp = static_cast<double>(kHeight) / (kChannels * kChannelWidth);  // square pixels
  const RasterImage wide = draw(database, "channels_wide", kChannels * kChannelWidth, pose, {frustum(-1, 1, tanUp)});
  int sky = 0, otherSky = 0, otherDistance = 0;
  for (int channel = 0; channel < kChannels; ++channel) {
    const double tanLeft = -1 + channel * 2.0 / kChannels;
    const RasterImage part =
        draw(database, "channels_part", kChannelWidth, pose, {frustum(tanLeft, tanLeft + 2.0 / kChannels, tanUp)});
    for (int row = 0; row < kHeight; ++row) {
      for (int column = 0; column < kChannelWidth; ++column) {
        const float a = wide.at(0, row, channel * kChannelWidth + column), b = part.at(0, row, column);
        sky += std::isnan(a);
        otherSky += std::isnan(a) != std::isnan(b);
        otherDistance += std::abs(a - b) > 2e-3f * a;
      }
    }
  }
  // Edges fall to one pixel or the next by the rounding of their corners in the one grid and in the other.
  constexpr int kPixels = kHeight * kChannelWidth * kChannels;
  CAPTURE(sky, otherSky, otherDistance);
  CHECK(sky > kPixels / 20);
  CHECK(sky < kPixels * 19 / 20);
  CHECK(otherSky < kPixels / 1000);
  CHECK(otherDistance < kPixels / 200);
}

TEST_CASE("channels: views turned against the aircraft's nose see what the wide picture has there") {
  const std::string database = carpathiaDatabase();
  if (database.empty()) return;
  constexpr double kDeg = 57.29577951308232, kTurnDeg = 30;
  const std::string pose = "49.25,20.1,2600,180,-5,7";
  const double wideUp = 1.2;  // a turned view's corners lie beyond its own height in the wide picture
  const int wideHeight = 480, wideWidth = static_cast<int>(wideHeight * std::tan(60 / kDeg) / wideUp);
  const RasterImage wide = draw(database, "channels_flat", wideWidth, pose,
                                {frustum(-std::tan(60 / kDeg), std::tan(60 / kDeg), wideUp)}, wideHeight);
  for (const int side : {-1, 1}) {
    const double c = std::cos(side * kTurnDeg / kDeg), s = std::sin(side * kTurnDeg / kDeg);
    const RasterImage turned = draw(database, "channels_turned", kChannelWidth, pose,
                                    {"--fov", "60", "--view-offset", std::to_string(side * kTurnDeg) + ",0,0"});
    const double across = std::tan(30 / kDeg), down = across * kHeight / kChannelWidth;
    int checked = 0, different = 0;
    for (int row = 0; row < kHeight; ++row) {
      for (int column = 0; column < kChannelWidth; ++column) {
        // The pixel's ray: ahead, right and down of the view, then of the nose.
        const double right = ((column + 0.5) / kChannelWidth * 2 - 1) * across;
        const double below = ((row + 0.5) / kHeight * 2 - 1) * down;
        const double ahead = c - s * right, x = (s + c * right) / ahead, y = below / ahead;
        const int wideColumn = static_cast<int>((x / std::tan(60 / kDeg) + 1) / 2 * wideWidth);
        const int wideRow = static_cast<int>((y / wideUp + 1) / 2 * wideHeight);
        if (wideColumn < 1 || wideColumn + 1 >= wideWidth || wideRow < 1 || wideRow + 1 >= wideHeight) continue;
        // Its distance is among those of the wide picture's pixels round about, or is sky where one of them is.
        const float here = turned.at(0, row, column);
        float nearest = INFINITY, farthest = 0;
        bool skyNear = false;
        for (int dy = -1; dy <= 1; ++dy) {
          for (int dx = -1; dx <= 1; ++dx) {
            const float value = wide.at(0, wideRow + dy, wideColumn + dx);
            skyNear = skyNear || std::isnan(value);
            if (std::isnan(value)) continue;
            nearest = std::min(nearest, value);
            farthest = std::max(farthest, value);
          }
        }
        ++checked;
        different += std::isnan(here) ? !skyNear : here < nearest * 0.995f || here > farthest * 1.005f;
      }
    }
    CAPTURE(side, checked, different);
    CHECK(checked > kHeight * kChannelWidth * 9 / 10);
    CHECK(different < checked / 100);
  }
}

TEST_CASE("horizon: both tests and none give the same picture") {
  const std::string database = carpathiaDatabase();
  if (database.empty()) return;
  for (const char* pose : {"49.25,20.1,2600,180,0,0", "49.25,20.1,400000,200,-60,0", "31.5,35.4,-400,90,0,0"}) {
    const auto mapOf = [&](const std::vector<std::string>& more) {
      return draw(database, "horizon", kChannelWidth, pose, more).values;
    };
    const std::vector<float> ellipsoid = mapOf({"--horizon", "ellipsoid"}), paper = mapOf({"--horizon", "paper"});
    const std::vector<float> everything = mapOf({"--culling", "none", "--cache-gpu", "1024", "--cache-ram", "1024"});
    const auto differ = [&](const std::vector<float>& other) {
      int count = 0;
      for (size_t i = 0; i < ellipsoid.size(); ++i)
        count += !(ellipsoid[i] == other[i] || (std::isnan(ellipsoid[i]) && std::isnan(other[i])));
      return count;
    };
    INFO(pose);
    CHECK(differ(paper) == 0);
    CHECK(differ(everything) == 0);
  }
}

TEST_CASE("channels: a mirrored view is the picture of the other one in a mirror, with and without culling") {
  const std::string database = carpathiaDatabase();
  if (database.empty()) return;
  const std::string pose = "49.25,20.1,1900,180,-8,7";
  constexpr int kWidth = 320;
  // Off axis, so that a mirror that turned the view instead would show something else.
  const std::string frustumWord = "--frustum=-35,20,-22,12";
  for (const std::string culling : {"none", "dynamic"}) {
    const std::vector<std::string> common{frustumWord,    "--culling",           culling, "--depth-map", "160x100",
                                          "--screenshot", testFile("mirror.png")};
    const auto picture = [&](const std::string& mirror) {
      std::vector<std::string> words = common;
      words.insert(words.end(), {"--mirror", mirror});
      RasterImage map = draw(database, "mirror", kWidth, pose, words);
      return std::pair(std::move(map), readRaster(testFile("mirror.png")));
    };
    const auto [plainMap, plain] = picture("none");
    for (const std::string mirror : {"h", "v", "hv"}) {
      const auto [map, image] = picture(mirror);
      int sky = 0, otherSky = 0, otherDistance = 0, otherColour = 0;
      for (int row = 0; row < kHeight; ++row) {
        for (int column = 0; column < kWidth; ++column) {
          const int thereRow = mirror.ends_with('v') ? kHeight - 1 - row : row;
          const int thereColumn = mirror.starts_with('h') ? kWidth - 1 - column : column;
          const float a = plainMap.at(0, thereRow, thereColumn), b = map.at(0, row, column);
          sky += std::isnan(a);
          otherSky += std::isnan(a) != std::isnan(b);
          otherDistance += std::abs(a - b) > 2e-3f * a;
          float most = 0;
          for (int band = 0; band < 3; ++band)
            most = std::max(most, std::abs(plain.at(band, thereRow, thereColumn) - image.at(band, row, column)));
          otherColour += most > 4;  // of 255: dithering is by the place on the screen
        }
      }
      // Edges through a pixel's very middle fall to one side in both: single pixels along silhouettes.
      constexpr int kPixels = kWidth * kHeight;
      CAPTURE(culling, mirror, sky, otherSky, otherDistance, otherColour);
      CHECK(sky > kPixels / 20);
      CHECK(sky < kPixels * 19 / 20);
      CHECK(otherSky < kPixels / 1000);
      CHECK(otherDistance < kPixels / 200);
      CHECK(otherColour < kPixels / 100);
    }
  }
}

}  // namespace eye::truth
