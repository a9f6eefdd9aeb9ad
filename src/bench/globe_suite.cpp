// Suite `globe`: paper 004's Table 3 in shape, and flights over the poles and along the date line.
#include <algorithm>

#include <fmt/format.h>

#include "app/statistics.h"
#include "bench/globe_blocks.h"
#include "bench/globe_flights.h"
#include "bench/globe_published.h"
#include "bench/steered_generator.h"
#include "bench/suites.h"

namespace eye {
namespace {

// The paper states neither its viewpoint nor its field of view. Four of eight blocks at 62,763 km can only be over a
// corner of octants, since 84.7 degrees of arc around are in sight, and only when the disc's rim is out of view. A
// window 7 degrees wide and blocks of one and a half windows give equation (7)'s five levels.
constexpr LatLon kViewpoint{0, 0};
constexpr int kWindowPx = 512;
constexpr double kBlockPx = 768, kFovDeg = 7, kNearM = 1;
constexpr double kWideFovDeg = 60;  // eyepoint's default, for comparison
constexpr int kSettleFrames = 3, kFrames = 40, kQuickFrames = 8;
constexpr double kFlightS = 20, kQuickFlightS = 2, kStartS = 3, kQuickStartS = 1;
constexpr double kLowestM = 12'000;  // below the deepest trench

struct DistanceRow {
  PublishedGlobe published{};
  int level = 0;
  BlockCounts blocks, blocksPaper, blocksWide;  // by the ellipsoid's horizon, by equation (6); 60 degrees wide
  SelectionCounts selection;
  int coarsest = kMaxLevel, finest = 0;  // levels drawn
  double frameMs = 0, cpuMs = 0;
};

struct FlightRow {
  const char* name;
  GlobeFlightFigures figures;
};

View viewFrom(double altM, double fovDeg) {
  return makeView({{kViewpoint.latDeg, kViewpoint.lonDeg, altM}, 0, -90, 0},
                  symmetricFrustum(fovDeg, kWindowPx, kWindowPx, kNearM), kWindowPx, kWindowPx);
}

Result<void> countBlocks(GlobeBlocks& blocks, DistanceRow& row) {
  const double altM = row.published.distanceKm * 1000;
  const View view = viewFrom(altM, kFovDeg), wide = viewFrom(altM, kWideFovDeg);
  row.level = levelByDistance(kWindowPx, kBlockPx, kFovDeg, altM);
  const auto count = [&](const View& of, HorizonTest test, BlockCounts& counts) -> Result<void> {
    const Result<BlockCounts> counted = blocks.count(row.level, of, test);
    if (!counted) return tl::unexpected(counted.error());
    counts = *counted;
    return {};
  };
  if (auto ok = count(view, HorizonTest::ellipsoid, row.blocks); !ok) return ok;
  if (auto ok = count(view, HorizonTest::paper, row.blocksPaper); !ok) return ok;
  return count(wide, HorizonTest::ellipsoid, row.blocksWide);
}

Result<void> draw(SteeredGenerator& generator, int frames, DistanceRow& row) {
  const Pose pose{{kViewpoint.latDeg, kViewpoint.lonDeg, row.published.distanceKm * 1000}, 0, -90, 0};
  std::vector<double> frameMs, cpuMs;
  for (int i = 0; i < kSettleFrames + frames; ++i) {
    const Result<FrameRecord> record = generator.frame(pose);
    if (!record) return tl::unexpected(record.error());
    row.selection = record->selection;
    if (i < kSettleFrames) continue;
    frameMs.push_back(record->frameMs);
    cpuMs.push_back(record->cpuMs);
  }
  row.frameMs = summarize(std::move(frameMs)).median;
  row.cpuMs = summarize(std::move(cpuMs)).median;
  const ImageGenerator& drawn = generator.generator();
  for (const DrawnChunk& chunk : drawn.selection().draws) {
    const int level = drawn.terrain().node(chunk.node).meta.key.level();
    row.coarsest = std::min(row.coarsest, level);
    row.finest = std::max(row.finest, level);
  }
  return {};
}

nlohmann::ordered_json jsonOf(const DistanceRow& row) {
  return {{"distance_km", row.published.distanceKm},
          {"level", row.level},
          {"blocks", row.blocks.blocks},
          {"visible", row.blocks.visible},
          {"culled_share", row.blocks.culledShare()},
          {"fps", 1000 / row.frameMs},
          {"published_culled_share", row.published.culledShare},
          {"published_level", row.published.level},
          {"published_blocks", row.published.blocks},
          {"published_visible", row.published.visible},
          {"published_fps", row.published.fps},
          {"frame_ms", row.frameMs},
          {"cpu_ms", row.cpuMs},
          {"culled_share_equation_6", row.blocksPaper.culledShare()},
          {"culled_share_60_degrees", row.blocksWide.culledShare()},
          {"drawn", row.selection.drawn},
          {"drawn_coarsest_level", row.coarsest},
          {"drawn_finest_level", row.finest}};
}

nlohmann::ordered_json jsonOf(const FlightRow& row) {
  const GlobeFlightFigures& figures = row.figures;
  return {
      {"flight", row.name},
      {"frames", figures.frames},
      {"missing_after_start", figures.missingAfterStart},
      {"frame_ms", {{"median", figures.frameMs.median}, {"p99", figures.frameMs.p99}, {"max", figures.frameMs.max}}},
      {"frames_looked_at", figures.framesLookedAt},
      {"hole_pixels", figures.holes}};
}

std::string percent(double share) {
  return fmt::format("{:.1f} %", 100 * share);
}

ReportTable publishedTable(const std::vector<DistanceRow>& rows) {
  ReportTable table{.caption = "Levels, blocks and culling: next to Table 3 of the paper",
                    .groups = {{"", 1}, {"level", 2}, {"blocks", 2}, {"visible", 2}, {"culled", 2}, {"fps", 2}},
                    .columns = {"distance"}};
  for (int block = 0; block < 5; ++block)
    for (const char* name : {"ours", "published"}) table.columns.emplace_back(name);
  for (const DistanceRow& row : rows) {
    const PublishedGlobe& theirs = row.published;
    table.rows.push_back(
        {fmt::format("{:.0f} km", theirs.distanceKm), std::to_string(row.level), std::to_string(theirs.level),
         std::to_string(row.blocks.blocks), std::to_string(theirs.blocks), std::to_string(row.blocks.visible),
         std::to_string(theirs.visible), percent(row.blocks.culledShare()), percent(theirs.culledShare),
         fmt::format("{:.0f}", 1000 / row.frameMs), fmt::format("{:.0f}", theirs.fps)});
  }
  return table;
}

ReportTable drawnTable(const std::vector<DistanceRow>& rows) {
  ReportTable table{.caption = "What is drawn: levels by error on screen, beside equation (7)'s",
                    .columns = {"distance", "equation (7)", "levels drawn", "chunks drawn", "wall ms", "CPU ms",
                                "culled by equation (6)", fmt::format("culled, {:.0f} degrees wide", kWideFovDeg)}};
  for (const DistanceRow& row : rows) {
    table.rows.push_back({fmt::format("{:.0f} km", row.published.distanceKm), std::to_string(row.level),
                          fmt::format("{} to {}", row.coarsest, row.finest), std::to_string(row.selection.drawn),
                          fmt::format("{:.1f}", row.frameMs), fmt::format("{:.1f}", row.cpuMs),
                          percent(row.blocksPaper.culledShare()), percent(row.blocksWide.culledShare())});
  }
  return table;
}

ReportTable flightTable(const std::vector<FlightRow>& rows) {
  ReportTable table{.caption = "Flights in real time, 8 km/s at 30 km, 25 frames a second, from a cold start",
                    .columns = {"flight", "frames", "missing after the start", "median ms", "p99 ms", "max ms",
                                "frames searched", "hole pixels"}};
  for (const FlightRow& row : rows) {
    const GlobeFlightFigures& f = row.figures;
    table.rows.push_back({row.name, std::to_string(f.frames), std::to_string(f.missingAfterStart),
                          fmt::format("{:.1f}", f.frameMs.median), fmt::format("{:.1f}", f.frameMs.p99),
                          fmt::format("{:.1f}", f.frameMs.max), std::to_string(f.framesLookedAt),
                          std::to_string(f.holes)});
  }
  return table;
}

SuiteReport reportOf(const std::vector<DistanceRow>& rows, const std::vector<FlightRow>& flights) {
  SuiteReport report{.name = "globe",
                     .title = "Globe: levels, blocks and culling from space",
                     .introduction =
                         "How much of the globe a view from space needs, as in Table 3 of the SDOG-ESSG "
                         "paper, and flights where the grid is at its worst."};
  double leastMargin = 1;
  for (const DistanceRow& row : rows) {
    report.rows.push_back(jsonOf(row));
    leastMargin = std::min(leastMargin, row.blocks.culledShare() - row.published.culledShare);
  }
  size_t missing = 0, holes = 0;
  report.summary = {{"fov_deg", kFovDeg},
                    {"window", fmt::format("{0}x{0}", kWindowPx)},
                    {"viewpoint", {kViewpoint.latDeg, kViewpoint.lonDeg}},
                    {"least_margin_of_culled_share", leastMargin},
                    {"flights", nlohmann::ordered_json::array()}};
  for (const FlightRow& flight : flights) {
    report.summary["flights"].push_back(jsonOf(flight));
    missing += flight.figures.missingAfterStart;
    holes += flight.figures.holes;
  }
  report.targets = {{"culled share at each distance at least the published one",
                     fmt::format("margin {:+.1f} points", 100 * leastMargin), leastMargin >= 0},
                    {"no hole over the poles and along the date line", fmt::format("{} pixels", holes), holes == 0},
                    {"no frame with a chunk missing after the start", fmt::format("{} frames", missing), missing == 0}};
  report.tables = {publishedTable(rows), drawnTable(rows), flightTable(flights)};
  report.notes = {
      fmt::format(
          "View: {0}x{0} pixels, {1:.0f} degrees wide, straight down at {2:.0f} N {3:.0f} E, where four octants "
          "meet. The paper gives neither; its numbers of visible blocks are lower than what the visible disc "
          "holds, so its view was narrower than the disc. With a block of {4:.0f} pixels this one gives "
          "equation (7)'s five levels.",
          kWindowPx, kFovDeg, kViewpoint.latDeg, kViewpoint.lonDeg, kBlockPx),
      "Visible: blocks of the level that view frustum and horizon (lowered under the deepest ground) leave, each "
      "judged "
      "by its descendants. Frames are drawn by error on screen, as always, not by equation (7)."};
  return report;
}

}  // namespace

Result<SuiteReport> runGlobeSuite(const SuiteOptions& options) {
  const Result<DatabaseReader> reader =
      DatabaseReader::open(options.terrain.empty() ? defaultTerrainPath() : options.terrain);
  if (!reader) return tl::unexpected(reader.error());
  Options drawing;
  drawing.terrain = options.terrain;
  drawing.device = options.device;
  Options narrow = drawing;
  narrow.widthPx = narrow.heightPx = kWindowPx;
  narrow.fovDeg = kFovDeg;
  const double steps = static_cast<double>(kPublishedGlobe.size() + kGlobeFlights.size());
  double done = 0;
  const auto begin = [&](const std::string& what) {
    if (options.progress) options.progress(what, done / steps);
    ++done;
  };

  GlobeBlocks blocks(*reader);
  std::vector<DistanceRow> rows;
  Result<SteeredGenerator> still = SteeredGenerator::create(narrow);
  if (!still) return tl::unexpected(still.error());
  for (const PublishedGlobe& published : kPublishedGlobe) {
    begin(fmt::format("{:.0f} km", published.distanceKm));
    DistanceRow& row = rows.emplace_back();
    row.published = published;
    if (auto ok = countBlocks(blocks, row); !ok) return tl::unexpected(ok.error());
    if (auto ok = draw(*still, options.quick ? kQuickFrames : kFrames, row); !ok) return tl::unexpected(ok.error());
  }
  std::vector<FlightRow> flights;
  for (const GlobeFlight& flight : kGlobeFlights) {
    begin(flight.name);
    Result<SteeredGenerator> flying = SteeredGenerator::create(drawing, false);
    if (!flying) return tl::unexpected(flying.error());
    const Result<GlobeFlightFigures> figures = flyOverGlobe(*flying, flight, options.quick ? kQuickFlightS : kFlightS,
                                                            options.quick ? kQuickStartS : kStartS, kLowestM);
    if (!figures) return tl::unexpected(figures.error());
    flights.push_back({flight.name, *figures});
  }
  SuiteReport report = reportOf(rows, flights);
  report.device = still->generator().renderer().device().name;
  return report;
}

}  // namespace eye
