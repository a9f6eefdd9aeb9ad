// Suite `floor`: each benchmark view's frame against what its visible triangles alone would cost.
#include <algorithm>

#include <fmt/format.h>

#include "bench/floor_study.h"
#include "bench/suites.h"

namespace eye {
namespace {

constexpr FloorEffort kQuickEffort{.frames = 8, .settle = 120};
constexpr size_t kQuickViews = 3;
constexpr uint64_t kCacheMiB = 512;  // the replays lie in the pools beside the terrain
constexpr double kMostRatio = 1.3;   // what is aimed at

}  // namespace

Result<std::vector<FloorView>> measureFloors(const SuiteOptions& options, std::string& device) {
  const std::string path = options.terrain.empty() ? defaultTerrainPath() : options.terrain;
  const Result<DatabaseReader> reader = DatabaseReader::open(path);
  if (!reader) return tl::unexpected(reader.error());
  const auto places = findPlaces(*reader);
  if (!places) return tl::unexpected(places.error());
  Options generatorOptions;
  generatorOptions.terrain = options.terrain;
  generatorOptions.device = options.device;
  generatorOptions.cacheGpuMiB = kCacheMiB;
  Result<SteeredGenerator> generator = SteeredGenerator::create(generatorOptions);
  if (!generator) return tl::unexpected(generator.error());
  device = generator->generator().renderer().device().name;
  ChunkShelf shelf(*reader);
  std::vector<FloorView> floors;
  std::vector<BenchView> views = benchViews(*places);
  if (options.quick) views.resize(kQuickViews);
  for (const BenchView& view : views) {
    if (options.progress)
      options.progress("floor of " + view.name, static_cast<double>(floors.size()) / static_cast<double>(views.size()));
    Result<FloorView> floor = measureFloor(*generator, view, shelf, options.quick ? kQuickEffort : FloorEffort{});
    if (!floor) return tl::unexpected(floor.error());
    floors.push_back(std::move(*floor));
  }
  return floors;
}

Result<SuiteReport> runFloorSuite(const SuiteOptions& options) {
  SuiteReport report{.name = "floor",
                     .title = "The floor",
                     .introduction =
                         "What each view costs, and what the triangles that show at least one pixel would "
                         "cost alone, drawn front to back by the same pipeline."};
  const Result<std::vector<FloorView>> floors = measureFloors(options, report.device);
  if (!floors) return tl::unexpected(floors.error());
  addFloor(*floors, report);
  for (const FloorView& floor : *floors) report.rows.push_back(floorJson(floor));
  return report;
}

void addFloor(const std::vector<FloorView>& floors, SuiteReport& report) {
  const double ratio = floorRatio(floors);
  report.summary["floor_ratio"] = ratio;
  report.targets.push_back(
      {fmt::format("CPU time of a frame over that of its visible triangles (at most {})", kMostRatio),
       fmt::format("{:.2f}", ratio), ratio <= kMostRatio});
  report.tables.push_back(floorTable(floors));
  report.tables.push_back(floorRestTable(floors));
  report.notes.emplace_back(
      "floor: the triangles that are nearest at a pixel's centre at least once, by an identity buffer drawn in "
      "doubles; "
      "replayed as index lists of them alone, chunks front to back, and the sky. off px: pixels that the replay shows "
      "in "
      "another colour than the frame. Each further column of the second table adds triangles to the replay, so that it "
      "says what those cost; culling and its draws: the frame's own culling passes and split draws over one draw a "
      "chunk; selection: all else of the frame. Medians of frames drawn in turn. model: lavapipe's costs by triangle "
      "and pixel as once measured on two cores of a Zen 5, for other processors no more than a scale.");
}

}  // namespace eye
