// eyepoint-panorama as its users see it: every column one azimuth, every row one elevation, judged by rays cast in
// double precision on the source.
#include <algorithm>
#include <cmath>
#include <thread>

#include <fmt/format.h>
#include <catch2/catch.hpp>

#include "system/program.h"
#include "system/rasters.h"
#include "truth/ray_caster.h"
#include "truth/truth_metric.h"

namespace eye::truth {
namespace {

constexpr double kRad = 0.017453292519943295;
constexpr int kWidthPx = 2048, kHeightPx = 284;  // 49.9 degrees
constexpr const char* kVerticalFov = "50";
constexpr double kDegPerPx = 360.0 / kWidthPx;

struct Standpoint {
  const char* name;
  double latDeg, lonDeg, altM;
  int knownPercent;  // of the columns whose skyline is the data's, not beyond them
};
constexpr Standpoint kStandpoints[] = {{"rysy", 49.1795, 20.0881, 2600, 5}, {"valley", 49.2040, 20.0700, 1700, 85}};

class Column {
 public:
  Column(const HeightGrid& grid, const Standpoint& at, double azimuthDeg)
      : grid_(grid), eye_(ecefFromPlace({at.latDeg, at.lonDeg, at.altM})) {
    const LocalFrame frame = frameAt(eye_);
    level_ = std::cos(azimuthDeg * kRad) * frame.north + std::sin(azimuthDeg * kRad) * frame.east;
    up_ = frame.up;
  }
  Hit at(double elevationDeg) const {
    return castRay(grid_, eye_, std::cos(elevationDeg * kRad) * level_ + std::sin(elevationDeg * kRad) * up_);
  }
  // A ray meets the sky just where it is above the highest elevation angle of all the terrain: bisection finds that.
  // Where rays near it meet a void or the data's fringe, it is known to lie between two angles.
  struct Skyline {
    double leastDeg, mostDeg;
  };
  Skyline skyline() const {
    const auto bisect = [&](bool unknownIsSky) {
      double terrain = -25, sky = 45;
      while (sky - terrain > kDegPerPx / 64) {
        const double mid = (terrain + sky) / 2;
        const HitKind kind = at(mid).kind;
        (kind == HitKind::sky || (unknownIsSky && kind == HitKind::unknown) ? sky : terrain) = mid;
      }
      return sky;
    };
    return {bisect(true), bisect(false)};
  }

 private:
  const HeightGrid& grid_;
  Vec eye_, level_, up_;
};

double yOf(double elevationDeg) {
  return kHeightPx / 2.0 - elevationDeg / kDegPerPx;
}

// Runs `work(column)` for columns -1 to `last`, on every core.
template <class Work>
void forColumns(int last, const Work& work) {
  const int threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  std::vector<std::jthread> workers;
  for (int i = 0; i < threads; ++i)
    workers.emplace_back([&, i] {
      for (int column = i - 1; column <= last; column += threads) work(column);
    });
}

RasterImage panoramaOf(const std::string& database, const Standpoint& at, const std::vector<std::string>& more = {}) {
  const std::string base = testFile(std::string("panorama/") + at.name);
  std::vector<std::string> arguments{"--terrain",      database,
                                     "--at",           fmt::format("{},{},{}", at.latDeg, at.lonDeg, at.altM),
                                     "--width",        std::to_string(kWidthPx),
                                     "--vertical-fov", kVerticalFov,
                                     "--refraction",   "0",
                                     "--out",          base};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const ProgramRun run = runProgram("eyepoint-panorama", arguments);
  INFO(run.err);
  REQUIRE(run.exitCode == 0);
  RasterImage map = readRaster(base + ".distance.tif");
  REQUIRE(map.widthPx == kWidthPx);
  REQUIRE(map.heightPx == kHeightPx);
  REQUIRE(map.noDataIsNan);
  const RasterImage picture = readRaster(base + ".png");
  REQUIRE(picture.widthPx == kWidthPx);
  REQUIRE(picture.heightPx == kHeightPx);
  return map;
}

}  // namespace

TEST_CASE("panorama: the skyline and every distance against rays on the source") {
  const std::string database = carpathiaDatabase();
  if (database.empty()) return;
  const HeightGrid grid = HeightGrid::fromHgtFolder(testFile("carpathia"));
  for (const Standpoint& at : kStandpoints) {
    CAPTURE(at.name);
    const RasterImage map = panoramaOf(database, at);

    // How far the highest row of terrain is off, and whether the truth is known to a tenth of a row.
    std::vector<double> offPx(kWidthPx, 0);
    std::vector<char> isKnown(kWidthPx, 0);
    forColumns(kWidthPx - 1, [&](int column) {
      if (column < 0) return;
      const auto skyline = Column(grid, at, (column + 0.5) * kDegPerPx).skyline();
      int row = 0;
      while (row < kHeightPx && std::isnan(map.at(0, row, column))) ++row;
      const double highest = yOf(skyline.mostDeg), lowest = yOf(skyline.leastDeg);
      offPx[static_cast<size_t>(column)] = row - std::clamp(static_cast<double>(row), highest, lowest);
      isKnown[static_cast<size_t>(column)] = lowest - highest < 0.1;
    });
    const auto within = std::ranges::count_if(offPx, [](double off) { return std::abs(off) <= 1; });
    const auto known = std::ranges::count(isKnown, 1);
    fmt::print("panorama {}: skyline within a pixel in {} of {} columns, {} of them known exactly\n", at.name, within,
               kWidthPx, known);
    CHECK(within * 1000 >= kWidthPx * 999);
    CHECK(known * 100 >= kWidthPx * at.knownPercent);

    TruthImage truth{kWidthPx, kHeightPx, std::vector<Hit>(size_t{kWidthPx + 2} * size_t{kHeightPx + 2})};
    forColumns(kWidthPx, [&](int column) {
      const Column rays(grid, at, (column + 0.5) * kDegPerPx);
      for (int row = -1; row <= kHeightPx; ++row)
        truth.hits[static_cast<size_t>(row + 1) * (kWidthPx + 2) + static_cast<size_t>(column + 1)] =
            rays.at((kHeightPx / 2.0 - row - 0.5) * kDegPerPx);
    });
    const Comparison result = compare(truth, map.values);
    fmt::print("panorama {}: {}\n", at.name, summaryLine(result));
    CHECK(result.assessed > 0.9 * kWidthPx * kHeightPx);
    CHECK(result.explainedShare() > 0.999);
    CHECK(result.medianError < 2e-4);
  }
}

TEST_CASE("panorama: the paper's depth is planar, coarse and nearer than the range") {
  const std::string database = carpathiaDatabase();
  if (database.empty()) return;
  const RasterImage range = panoramaOf(database, kStandpoints[0]);
  const RasterImage paper = panoramaOf(database, kStandpoints[0], {"--depth", "paper"});
  const int level = kHeightPx / 2 + 4;
  for (int column = 0; column < kWidthPx; column += 7) {
    const double r = range.at(0, level, column), p = paper.at(0, level, column);
    if (std::isnan(r) || std::isnan(p)) continue;
    const double turnDeg = std::fmod((column + 0.5) * kDegPerPx, 45.0) - 22.5;
    CHECK(p == Approx(r * std::cos(turnDeg * kRad)).epsilon(0.05));
  }
}

TEST_CASE("panorama: peaks with their distances, and what is wrong in one line") {
  const std::string database = carpathiaDatabase();
  if (database.empty()) return;
  const std::string peaks = testFile("panorama/peaks.csv"), base = testFile("panorama/rysy");
  writeText(peaks, "name,lat,lon,height\nGerlach,49.1642,20.1339,2655\nKrivan,49.1625,20.0,2495\nFar,-10,20.2,3000\n");
  (void)panoramaOf(database, kStandpoints[0], {"--peaks", peaks});
  const std::string csv = readText(base + ".peaks.csv");
  INFO(csv);
  CHECK(csv.starts_with("name,lat,lon,height_m,azimuth_deg,elevation_deg,visible,distance_m,true_distance_m,error_m"));
  CHECK(csv.find("\"Gerlach\",49.164200,20.133900,2655.0,116.98") != std::string::npos);
  CHECK(csv.find("\"Far\"") == std::string::npos);

  const auto fails = [&](const std::vector<std::string>& arguments, int exitCode, const std::string& says) {
    const ProgramRun run = runProgram("eyepoint-panorama", arguments);
    INFO(joined(arguments) << "\n" << run.err);
    CHECK(run.exitCode == exitCode);
    CHECK(run.errorLines().size() == 1);
    CHECK(run.err.find(says) != std::string::npos);
  };
  const std::vector<std::string> good{"--terrain", database, "--out", base, "--at", "49.1795,20.0881"};
  const auto with = [&](std::vector<std::string> more) {
    std::vector<std::string> all = good;
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  fails({"--terrain", database, "--out", base}, 2, "--at");
  fails({"--terrain", database, "--at", "49,20"}, 2, "--out");
  fails({"--terrain", database, "--out", base, "--at", "49.1795,20.0881,1000"}, 2, "above the ground");
  fails({"--terrain", database, "--out", base, "--at", "49.1795"}, 2, "--at '49.1795'");
  fails({"--terrain", "/nowhere.eyt", "--out", base, "--at", "49,20"}, 1, "/nowhere.eyt");
  fails({"--terrain", database, "--out", "/nowhere/base", "--at", "49,20"}, 1, "/nowhere/base");
  fails(with({"--width", "100"}), 2, "--width 100");
  fails(with({"--width", "1e9"}), 2, "--width");
  fails(with({"--vertical-fov", "nan"}), 2, "--vertical-fov nan");
  fails(with({"--vertical-fov", "91"}), 2, "--vertical-fov 91");
  fails(with({"--refraction", "nan"}), 2, "--refraction");
  fails(with({"--refraction", "-0.1"}), 2, "--refraction");
  fails(with({"--time-of-day", "25"}), 2, "--time-of-day");
  fails(with({"--visibility", "0"}), 2, "--visibility");
  fails(with({"--cache-gpu", "1"}), 2, "--cache-gpu");
  fails(with({"--earth", "flat"}), 2, "--earth");
  fails(with({"--depth", "guess"}), 2, "--depth");
  fails(with({"--peaks", "/nowhere.csv"}), 1, "/nowhere.csv");
  fails(with({"--peaks", database}), 1, "carpathia.eyt");
}

}  // namespace eye::truth
