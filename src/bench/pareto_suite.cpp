// Suite `pareto`: run time against error, along the axes of what a user can choose, and the floor.
#include <algorithm>

#include <fmt/format.h>

#include "bench/floor_study.h"
#include "bench/pareto_report.h"
#include "bench/suites.h"

namespace eye {
namespace {

constexpr size_t kViews = 3, kQuickViews = 1;
constexpr int kPicturesASide = 8;  // 64 samples
constexpr ParetoEffort kQuickEffort{.frames = 8, .settle = 3, .selectorFrames = 40};

}  // namespace

Result<SuiteReport> runParetoSuite(const SuiteOptions& options) {
  const std::string path = options.terrain.empty() ? defaultTerrainPath() : options.terrain;
  const Result<DatabaseReader> reader = DatabaseReader::open(path);
  if (!reader) return tl::unexpected(reader.error());
  const auto places = findPlaces(*reader);
  if (!places) return tl::unexpected(places.error());
  std::vector<BenchView> views = benchViews(*places);
  views.resize(options.quick ? kQuickViews : kViews);
  std::vector<LatLon> around;
  for (const BenchView& view : views) around.push_back({view.pose.position.latDeg, view.pose.position.lonDeg});

  SuiteReport report{.name = "pareto",
                     .title = "Time against error",
                     .introduction =
                         "What a frame costs, and how far its picture is from the truth, along the axes of "
                         "what one may choose; and what its visible triangles alone would cost."};
  Result<std::unique_ptr<TrueDistances>> distances = openTrueDistances(*reader, options.elevation, around);
  if (!distances) return tl::unexpected(distances.error());
  ParetoRuns runs(options.terrain, options.device, views, **distances);
  const std::vector<ParetoBlock> blocks = paretoBlocks(options.quick);
  // The floor, a truth for each size, the blocks.
  const double steps = 1 + 2 + static_cast<double>(blocks.size());
  SuiteOptions floorOptions = options;
  if (options.progress)
    floorOptions.progress = [&](const std::string& what, double share) { options.progress(what, share / steps); };
  const Result<std::vector<FloorView>> floors = measureFloors(floorOptions, report.device);
  if (!floors) return tl::unexpected(floors.error());
  double done = 1;
  const auto begin = [&](const std::string& what) {
    if (options.progress) options.progress(what, done++ / steps);
  };
  std::vector<ParetoResult> results;
  std::vector<glm::ivec2> sizes;
  for (const ParetoBlock& block : blocks) {
    const glm::ivec2 sizePx = block.front().sizePx;
    if (std::ranges::find(sizes, sizePx) == sizes.end()) {
      begin("truth at " + block.front().sizeName());
      sizes.push_back(sizePx);
      if (const Result<void> made = runs.makeTruths(sizePx, kPicturesASide); !made) return tl::unexpected(made.error());
    }
    begin(fmt::format("{} settings, the last {}", block.size(), block.back().name()));
    Result<std::vector<ParetoResult>> measured = runs.measure(block, options.quick ? kQuickEffort : ParetoEffort{});
    if (!measured) return tl::unexpected(measured.error());
    for (ParetoResult& result : *measured)
      if (std::ranges::find(results, result.setting, &ParetoResult::setting) == results.end())
        results.push_back(std::move(result));
  }
  addPareto(results, (*distances)->description(), report);
  addFloor(*floors, report);
  std::string names;
  for (const BenchView& view : views) names += (names.empty() ? "" : ", ") + view.name;
  report.notes.push_back(fmt::format("{}: {}, level, towards the highest ground, 60 degrees wide.", path, names));
  return report;
}

}  // namespace eye
