// Magenta behind the terrain: wherever a ray meets the sea-level ellipsoid, and terrain is nowhere below it, magenta is
// a hole.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <random>

#include "system/program.h"
#include "system/rasters.h"
#include "truth/wgs84.h"

namespace eye::truth {
namespace {

constexpr int kWidth = 400, kHeight = 300;
constexpr double kFovDeg = 60;
constexpr int kPoses = 100;  // a database
constexpr int kRim = 2;      // pixels from the horizon inwards that are not judged: a silhouette may be a pixel off

// Whether the ray meets the ellipsoid: a quadratic after scaling it to the unit sphere.
bool meetsSea(Vec eye, Vec direction) {
  constexpr double kA = 6378137.0, kB = 6356752.314245;
  const Vec e{eye.x / kA, eye.y / kA, eye.z / kB}, d{direction.x / kA, direction.y / kA, direction.z / kB};
  const double along = dot(e, d);
  return along < 0 && along * along > dot(d, d) * (dot(e, e) - 1);
}

std::vector<bool> seaMask(const EyePose& pose) {
  const Vec eye = ecefFromPlace(pose.at);
  const EyeAxes axes = axesOf(pose);
  const double pixel = 2 * std::tan(kFovDeg / 2 / 57.29577951308232) / kWidth;
  std::vector<bool> mask;
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      const double right = (column + 0.5 - kWidth / 2.0) * pixel, up = (kHeight / 2.0 - row - 0.5) * pixel;
      mask.push_back(meetsSea(eye, axes.forward + right * axes.right + up * axes.up));
    }
  }
  return mask;
}

bool isMagenta(const RasterImage& image, int row, int column) {
  return image.at(0, row, column) > 254 && image.at(1, row, column) < 1 && image.at(2, row, column) > 254;
}

struct Holes {
  int belowHorizon = 0;  // rays that meet the sea
  int belowTerrain = 0;  // under terrain of the same column, in a level view
  int row = 0, column = 0;
};

Holes findHoles(const RasterImage& image, const EyePose& pose) {
  const std::vector<bool> sea = seaMask(pose);
  const auto seaAround = [&](int row, int column) {
    // The horizon may lie just beyond the picture's edge.
    if (row < kRim || row >= kHeight - kRim || column < kRim || column >= kWidth - kRim) return false;
    for (int r = row - kRim; r <= row + kRim; ++r)
      for (int c = column - kRim; c <= column + kRim; ++c)
        if (!sea[static_cast<size_t>(r * kWidth + c)]) return false;
    return true;
  };
  // A column of a level view without roll lies in a vertical plane, where nothing overhangs.
  const bool level = pose.pitchDeg == 0 && pose.rollDeg == 0;
  Holes holes;
  for (int column = 0; column < kWidth; ++column) {
    bool terrainAbove = false;
    for (int row = 0; row < kHeight; ++row) {
      const bool magenta = isMagenta(image, row, column);
      const bool hole = magenta && seaAround(row, column), under = magenta && level && terrainAbove;
      holes.belowHorizon += hole;
      holes.belowTerrain += under;
      if (hole || under) holes.row = row, holes.column = column;
      terrainAbove = terrainAbove || !magenta;
    }
  }
  return holes;
}

// Each pose stands still around its frame of the 60 Hz clock.
void writeTrack(const std::string& path, const std::vector<EyePose>& poses) {
  std::string text = "time,lat,lon,alt,heading,pitch,roll\n";
  for (size_t i = 0; i < poses.size(); ++i) {
    const EyePose& p = poses[i];
    const double frameS = static_cast<double>(i) / 60;
    for (const double timeS : {std::max(0.0, frameS - 0.004), frameS + 0.004}) {
      text += fmt::format("{:.6f},{:.10f},{:.10f},{:.4f},{:.6f},{:.6f},{:.6f}\n", timeS, p.at.latDeg, p.at.lonDeg,
                          p.at.altM, p.headingDeg, p.pitchDeg, p.rollDeg);
    }
  }
  writeText(path, text);
}

void checkPoses(const std::string& name, const std::string& database, const std::vector<EyePose>& poses) {
  const std::string track = testFile(name + ".csv"), frames = testFile(name + "_frames");
  writeTrack(track, poses);
  std::filesystem::remove_all(frames);
  const ProgramRun run = runProgram(
      "eyepoint",
      {"--headless", "--offline", "--terrain", database, "--host", "file://" + track, "--frames",
       std::to_string(poses.size()), "--fov", fmt::format("{}", kFovDeg), "--size",
       fmt::format("{}x{}", kWidth, kHeight), "--background", "1,0,1", "--frames-dir", frames, "--log-level", "error"},
      {.environment = {}, .timeoutS = 500});
  INFO(run.err);
  REQUIRE(run.exitCode == 0);
  std::vector<std::string> pictures;
  for (const auto& entry : std::filesystem::directory_iterator(frames)) pictures.push_back(entry.path());
  std::sort(pictures.begin(), pictures.end());
  REQUIRE(pictures.size() == poses.size());
  int withHoles = 0, withTerrain = 0;
  for (size_t i = 0; i < poses.size(); ++i) {
    const RasterImage image = readRaster(pictures[i]);
    REQUIRE(image.bands == 3);
    REQUIRE(image.widthPx == kWidth);
    const Holes holes = findHoles(image, poses[i]);
    bool terrain = false;
    for (int row = 0; row < kHeight && !terrain; ++row) terrain = !isMagenta(image, row, kWidth / 2);
    withTerrain += terrain;
    withHoles += holes.belowHorizon + holes.belowTerrain > 0;
    const EyePose& p = poses[i];
    INFO(fmt::format("{} at {},{},{} heading {} pitch {} roll {}: last hole at row {} column {}", pictures[i],
                     p.at.latDeg, p.at.lonDeg, p.at.altM, p.headingDeg, p.pitchDeg, p.rollDeg, holes.row,
                     holes.column));
    CHECK(holes.belowHorizon == 0);
    CHECK(holes.belowTerrain == 0);
  }
  fmt::print("{}: {} poses, {} show terrain, {} have holes\n", name, poses.size(), withTerrain, withHoles);
  CHECK(withTerrain > kPoses / 2);  // the test looks at something
}

}  // namespace

TEST_CASE("cracks: the test itself sees a hole of one pixel") {
  RasterImage image{kWidth, kHeight, 3, false, false, std::vector<float>(size_t{3} * kWidth * kHeight, 90)};
  const auto setMagenta = [&](int row, int column) {
    const auto pixel = static_cast<size_t>(row * kWidth + column), plane = static_cast<size_t>(kWidth * kHeight);
    image.values[pixel] = image.values[2 * plane + pixel] = 255;
    image.values[plane + pixel] = 0;
  };
  const EyePose down{{49, 20, 5000}, 30, -60, 20}, level{{49, 20, 5000}, 30, 0, 0};
  CHECK(findHoles(image, down).belowHorizon == 0);
  setMagenta(40, 100);  // far above the horizon of the level view
  CHECK(findHoles(image, down).belowHorizon == 1);
  CHECK(findHoles(image, level).belowHorizon == 0);
  CHECK(findHoles(image, level).belowTerrain == 1);  // a mountain that hangs in the air above it
  setMagenta(250, 100);
  CHECK(findHoles(image, level).belowHorizon == 1);
}

TEST_CASE("cracks: none in the Tatra, from treetops to orbit") {
  const std::string database = carpathiaDatabase();
  if (database.empty()) return;
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<EyePose> poses;
  for (int i = 0; i < kPoses; ++i) {
    // Heights evenly in their logarithm, 2,700 m (over every summit) to 300 km: every level meets every other.
    const double altM = 2700 * std::pow(110, unit(random) * unit(random));
    EyePose pose{{49.0 + 0.4 * unit(random), 19.6 + 0.8 * unit(random), altM}, 360 * unit(random), 0, 0};
    if (i % 3 != 0) {  // every third is level, for the rule of columns
      pose.pitchDeg = -80 * unit(random);
      pose.rollDeg = 120 * unit(random) - 60;
    }
    poses.push_back(pose);
  }
  checkPoses("cracks_tatra", database, poses);
}

TEST_CASE("cracks: none at poles, date line and where the columns halve, on a rough globe") {
  // Relief of up to 6 km with features of a few degrees everywhere, poles included; one post every half degree.
  const GridShape shape{-89.75, -179.75, 0.5, 360, 720};
  const HeightGrid globe(shape, [](double lat, double lon) {
    const double y = lat / 57.3, x = lon / 57.3;
    const Vec p{std::cos(y) * std::cos(x), std::cos(y) * std::sin(x), std::sin(y)};
    const double rough =
        std::sin(19 * p.x + 3 * std::sin(11 * p.y)) * std::sin(23 * p.y + 5 * p.z) * std::cos(17 * p.z + 7 * p.x);
    return 6000 * rough * rough;
  });
  const std::string source = testFile("rough_globe.tif"), database = testFile("rough_globe.eyt");
  writeElevation(source, globe);
  std::remove(database.c_str());
  const ProgramRun bake =
      runProgram("eyepoint-bake", {"--elevation", source, "--out", database}, {.environment = {}, .timeoutS = 300});
  INFO(bake.err);
  REQUIRE(bake.exitCode == 0);

  std::mt19937 random(12);
  std::uniform_real_distribution<double> unit(0, 1);
  const double latitudes[] = {90, -90, 89.9, -89.7, 45, -45, 67.5, -67.5, 78.75, -78.75, 84.375, 0};
  const double longitudes[] = {0, 90, 180, -180, -90, 45, 179.9, -22.5};
  std::vector<EyePose> poses;
  for (int i = 0; i < kPoses; ++i) {
    const double near = unit(random) < 0.5 ? 0 : unit(random) - 0.5;
    EyePose pose;
    pose.at.latDeg = std::clamp(latitudes[random() % std::size(latitudes)] + near, -90.0, 90.0);
    pose.at.lonDeg = longitudes[random() % std::size(longitudes)];
    pose.at.altM = 7000 * std::pow(9000, unit(random));  // to 63,000 km
    pose.headingDeg = 360 * unit(random);
    if (i % 3 != 0) {
      pose.pitchDeg = -90 * unit(random);
      pose.rollDeg = 120 * unit(random) - 60;
    }
    if (pose.at.altM > 2'000'000) pose.pitchDeg = -90 + 25 * unit(random);  // from there the globe is a ball
    poses.push_back(pose);
  }
  checkPoses("cracks_globe", database, poses);
}

}  // namespace eye::truth
