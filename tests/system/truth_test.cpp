// The picture's geometry against rays cast on the source: the program draws, its distance map is judged pixel by pixel.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "raster/picture.h"
#include "system/program.h"
#include "system/rasters.h"
#include "system/truth_metric.h"

namespace eye::truth {
namespace {

constexpr int kWidth = 800, kHeight = 600;
constexpr double kFovDeg = 60;
constexpr double kFoot = 0.3048;

std::string poseText(const EyePose& p) {
  return fmt::format("{:.9f},{:.9f},{:.4f},{},{},{}", p.at.latDeg, p.at.lonDeg, p.at.altM, p.headingDeg, p.pitchDeg,
                     p.rollDeg);
}

// Draws, compares, prints one line, leaves a picture of the errors where the figures are not met.
void checkPose(const std::string& name, const HeightGrid& grid, const std::string& database, const EyePose& pose) {
  const std::string map = testFile("truth/" + name + ".distance.tif");
  const ProgramRun run =
      runProgram("eyepoint", {"--headless", "--offline", "--terrain", database, "--pose", poseText(pose), "--fov",
                              fmt::format("{}", kFovDeg), "--size", fmt::format("{}x{}", kWidth, kHeight), "--sse", "1",
                              "--distance-map", map, "--log-level", "error"});
  INFO(name << " " << poseText(pose) << "\n" << run.err);
  REQUIRE(run.exitCode == 0);
  const RasterImage rendered = readRaster(map);
  REQUIRE(rendered.bands == 1);
  REQUIRE(rendered.widthPx == kWidth);
  REQUIRE(rendered.heightPx == kHeight);
  CHECK(rendered.isFloat);
  CHECK(rendered.noDataIsNan);
  const Comparison result = compare(castImage(grid, pose, kFovDeg, kWidth, kHeight), rendered.values);
  fmt::print("{}: {}\n", name, summaryLine(result));
  const bool good = result.explainedShare() >= 0.999 && result.medianError < 5e-4 && result.skyBelowSkyline == 0;
  if (!good) {
    const std::string picture = testFile("truth/" + name + ".errors.png");
    CHECK(writePng(picture, errorPicture(result), kWidth, kHeight).has_value());
    UNSCOPED_INFO("where: " << picture);
  }
  CHECK(result.explainedShare() >= 0.999);
  CHECK(result.medianError < 5e-4);
  CHECK(result.skyBelowSkyline == 0);
  CHECK(result.assessed > kWidth * kHeight * 9 / 10);
}

struct TatraPose {
  const char* name;
  double latDeg, lonDeg, aboveGroundM, headingDeg, pitchDeg, rollDeg;
};

// From the foreland at 49.25 N 20.1 E towards the ridge, and around its highest peak, Gerlachovsky stit.
constexpr TatraPose kTatraPoses[] = {
    {"foreland_2000ft", 49.25, 20.10, 2000 * kFoot, 180, 0, 0},
    {"foreland_4000ft", 49.25, 20.10, 4000 * kFoot, 180, -15, 0},
    {"foreland_8000ft", 49.25, 20.10, 8000 * kFoot, 160, -15, 0},
    {"gerlach_2000ft", 49.1642, 20.1339, 2000 * kFoot, 315, -10, 0},
    {"gerlach_steep", 49.1642, 20.1339, 4000 * kFoot, 30, -60, 0},
    {"gerlach_roll60", 49.1700, 20.1600, 3000 * kFoot, 250, -5, 60},
    {"gerlach_8000ft", 49.1642, 20.1339, 8000 * kFoot, 90, 0, 0},
    {"valley_50m", 49.2040, 20.0700, 50, 170, 5, 0},
};

}  // namespace

TEST_CASE("truth: eight views of the Tatra") {
  const std::string database = carpathiaDatabase();
  if (database.empty()) return;
  static const HeightGrid grid = HeightGrid::fromHgtFolder(testFile("carpathia"));
  for (const TatraPose& p : kTatraPoses) {
    const double groundM = grid.heightM(grid.rowOf(p.latDeg), grid.columnOf(p.lonDeg));
    checkPose(p.name, grid, database,
              {{p.latDeg, p.lonDeg, groundM + p.aboveGroundM}, p.headingDeg, p.pitchDeg, p.rollDeg});
  }
}

TEST_CASE("truth: a plain and a cone") {
  // A cone of 1,500 m on a plain at 200 m, posts every 3 arc-seconds, half a degree wide.
  const GridShape shape{45, 7, 1.0 / 1200, 601, 601};
  const HeightGrid grid(shape, [](double lat, double lon) {
    return std::max(200.0, 1700 - std::hypot((lat - 45.25) * 111130, (lon - 7.25) * 78850) / 4);
  });
  const std::string source = testFile("cone.tif"), database = testFile("cone.eyt");
  writeElevation(source, grid);
  std::remove(database.c_str());
  const ProgramRun bake = runProgram("eyepoint-bake", {"--elevation", source, "--out", database});
  INFO(bake.err);
  REQUIRE(bake.exitCode == 0);
  checkPose("cone_above", grid, database, {{45.25, 7.25, 4000}, 0, -90, 0});
  checkPose("cone_side", grid, database, {{45.15, 7.25, 900}, 0, -10, 0});
  checkPose("plain_down", grid, database, {{45.40, 7.40, 1200}, 45, -60, 30});
}

}  // namespace eye::truth
