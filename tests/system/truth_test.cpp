// The picture's geometry against rays cast on the source: the program draws, its distance map is judged pixel by pixel.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "raster/picture.h"
#include "system/program.h"
#include "system/rasters.h"
#include "truth/truth_metric.h"

namespace eye::truth {
namespace {

constexpr int kWidth = 800, kHeight = 600;
constexpr double kFovDeg = 60;
constexpr double kFoot = 0.3048;

std::string poseText(const EyePose& p) {
  return fmt::format("{:.9f},{:.9f},{:.4f},{},{},{}", p.at.latDeg, p.at.lonDeg, p.at.altM, p.headingDeg, p.pitchDeg,
                     p.rollDeg);
}

// Draws frames of a still eye and leaves the last one's distance map in `map`.
void draw(const std::string& database, const EyePose& pose, const std::string& map,
          const std::vector<std::string>& more) {
  std::vector<std::string> arguments{"--headless",     "--offline",
                                     "--terrain",      database,
                                     "--pose",         poseText(pose),
                                     "--fov",          fmt::format("{}", kFovDeg),
                                     "--size",         fmt::format("{}x{}", kWidth, kHeight),
                                     "--distance-map", map,
                                     "--log-level",    "error"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const ProgramRun run = runProgram("eyepoint", arguments);
  INFO(poseText(pose) << "\n" << run.err);
  REQUIRE(run.exitCode == 0);
}

// Draws, compares, prints one line, leaves a picture of the errors where the figures are not met.
void checkPose(const std::string& name, const HeightGrid& grid, const std::string& database, const EyePose& pose) {
  const std::string map = testFile("truth/" + name + ".distance.tif");
  draw(database, pose, map, {"--sse", "1"});
  INFO(name << " " << poseText(pose));
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

EyePose poseOver(const HeightGrid& grid, const TatraPose& p) {
  const double groundM = grid.heightM(grid.rowOf(p.latDeg), grid.columnOf(p.lonDeg));
  return {{p.latDeg, p.lonDeg, groundM + p.aboveGroundM}, p.headingDeg, p.pitchDeg, p.rollDeg};
}

// Median over the frames of a statistics file but the first five, which load and settle.
double medianOf(const std::string& statistics, const char* key) {
  std::vector<double> values;
  std::ifstream file(statistics);
  for (std::string line; std::getline(file, line);) values.push_back(nlohmann::json::parse(line).at(key).get<double>());
  REQUIRE(values.size() > 5);
  values.erase(values.begin(), values.begin() + 5);
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

}  // namespace

// Not a test: the table of docs/MEASUREMENTS.md. test_system "truth: time against error"
TEST_CASE("truth: time against error", "[.]") {
  const std::string database = carpathiaDatabase();
  if (database.empty()) return;
  const HeightGrid grid = HeightGrid::fromHgtFolder(testFile("carpathia"));
  fmt::print("| view | `--sse` | triangles | wall ms | CPU ms | explained | median error | p99 error |\n");
  for (const TatraPose& p : {kTatraPoses[0], kTatraPoses[3]}) {
    const EyePose pose = poseOver(grid, p);
    const TruthImage truth = castImage(grid, pose, kFovDeg, kWidth, kHeight);
    for (const char* sse : {"8", "4", "2", "1", "0.5", "0.25"}) {
      const std::string map = testFile("truth/table.tif"), statistics = testFile("truth/table.jsonl");
      draw(database, pose, map, {"--sse", sse, "--frames", "45", "--redraw", "always", "--stats", statistics});
      const Comparison result = compare(truth, readRaster(map).values);
      fmt::print("| {} | {} | {:.0f} | {:.1f} | {:.1f} | {:.4f} % | {:.1e} | {:.1e} |\n", p.name, sse,
                 medianOf(statistics, "triangles"), medianOf(statistics, "frame_ms"), medianOf(statistics, "cpu_ms"),
                 100 * result.explainedShare(), result.medianError, result.p99Error);
    }
  }
}

TEST_CASE("truth: eight views of the Tatra") {
  const std::string database = carpathiaDatabase();
  if (database.empty()) return;
  static const HeightGrid grid = HeightGrid::fromHgtFolder(testFile("carpathia"));
  for (const TatraPose& p : kTatraPoses) checkPose(p.name, grid, database, poseOver(grid, p));
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
