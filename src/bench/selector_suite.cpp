// Suite `selector`: every fixed depth map and every mode of the selector fly the same flight, frame by frame in turn.
#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "bench/regret.h"
#include "bench/selector_flight.h"
#include "bench/steered_generator.h"
#include "bench/suites.h"

namespace eye {
namespace {

constexpr double kFrameS = 1.0 / 60;
// The flight is sampled: a burst of frames at 60 Hz every so often. The first frame of a burst makes up for the jump
// (chunks arrive, clusters come into view) and does not count.
constexpr double kBurstEveryS = 1.5, kQuickBurstEveryS = 30;
constexpr int kBurstFrames = 3;
// Frames before the flight begins, for chunks and the selector's first measurements.
constexpr int kWarmFrames = 4;
// Neighbours by which a fixed choice is judged, each way: three bursts, 4.5 s of flight.
constexpr size_t kReach = 3;
constexpr size_t kTenSeconds = 600;  // frames
constexpr double kMostRegret = 0.03, kMostLoss = 0.02;

struct Flyer {
  std::string mode;  // of the row
  bool isFixed = false;
  std::optional<SteeredGenerator> generator;
  FrameTimes cpuMs, frameMs;
  std::vector<DepthMapChoice> used;
};

Result<std::vector<Flyer>> makeFlyers(const SuiteOptions& suite) {
  std::vector<Flyer> flyers;
  const auto add = [&](std::string mode, bool isFixed, const auto& change) -> Result<void> {
    Options options;
    options.terrain = suite.terrain;
    options.device = suite.device;
    options.culling = CullingMode::dynamic;
    change(options);
    Result<SteeredGenerator> made = SteeredGenerator::create(options);
    if (!made) return tl::unexpected(made.error());
    flyers.push_back({std::move(mode), isFixed, std::move(*made), {}, {}, {}});
    return {};
  };
  Result<void> made = add("off", true, [](Options& options) { options.depthMap = DepthMapMode::off; });
  for (const DepthMapChoice choice : kDepthMaps) {
    if (!made) break;
    made = add(std::string(nameOf(choice)), true, [choice](Options& options) {
      options.depthMap = DepthMapMode::fixed;
      options.depthMapPx = {sizeOf(choice).widthPx, sizeOf(choice).heightPx};
    });
  }
  if (made) made = add("adaptive", false, [](Options& options) { options.selectorMode = SelectorMode::adaptive; });
  if (made) made = add("paper", false, [](Options& options) { options.selectorMode = SelectorMode::paper; });
  if (!made) return tl::unexpected(made.error());
  return flyers;
}

DepthMapChoice choiceOf(const FrameRecord& record) {
  if (!record.depthMapPx) return DepthMapChoice::off;
  for (const DepthMapChoice choice : kDepthMaps)
    if (sizeOf(choice).widthPx == record.depthMapPx->x) return choice;
  return DepthMapChoice::off;
}

// One frame of every flyer, beginning with another one each time: none has the warmer caches.
Result<void> flyFrame(std::vector<Flyer>& flyers, const Pose& pose, size_t turn, bool counts) {
  for (size_t i = 0; i < flyers.size(); ++i) {
    Flyer& flyer = flyers[(i + turn) % flyers.size()];
    const Result<FrameRecord> record = flyer.generator->frame(pose);
    if (!record) return tl::unexpected(record.error());
    if (!counts) continue;
    flyer.cpuMs.push_back(record->cpuMs);
    flyer.frameMs.push_back(record->frameMs);
    flyer.used.push_back(choiceOf(*record));
  }
  return {};
}

double mean(const FrameTimes& times) {
  return std::accumulate(times.begin(), times.end(), 0.0) / static_cast<double>(times.size());
}

std::string percent(double share) {
  return fmt::format("{:.1f} %", 100 * share);
}

// How often each depth map was used.
nlohmann::ordered_json usedShares(const Flyer& flyer) {
  nlohmann::ordered_json shares = nlohmann::ordered_json::object();
  for (int i = 0; i <= static_cast<int>(kDepthMapSizes); ++i) {
    const auto choice = static_cast<DepthMapChoice>(i);
    const auto count = std::ranges::count(flyer.used, choice);
    shares[std::string(nameOf(choice))] = static_cast<double>(count) / static_cast<double>(flyer.used.size());
  }
  return shares;
}

void addPlots(const std::vector<Flyer>& flyers, const std::vector<double>& timesS, const FrameTimes& bestMs,
              SuiteReport& report) {
  ReportPlot cost{.title = "CPU time of a frame over the flight (running medians)",
                  .xLabel = "seconds; plain, then mountains",
                  .yLabel = "ms"};
  ReportPlot size{.title = "The depth map that each mode used, its height in pixels (0: off)",
                  .xLabel = "seconds",
                  .yLabel = "pixels"};
  for (const Flyer& flyer : flyers) {
    if (!flyer.isFixed || flyer.mode == "off")
      cost.series.push_back({flyer.mode, timesS, runningMedian(flyer.cpuMs, kReach)});
    if (flyer.isFixed) continue;
    FrameTimes heights;
    for (const DepthMapChoice choice : flyer.used) heights.push_back(sizeOf(choice).heightPx);
    size.series.push_back({flyer.mode, timesS, std::move(heights)});
  }
  cost.series.push_back({"best in hindsight", timesS, runningMedian(bestMs, kReach)});
  ReportPlot height{.title = "Height above the ground", .xLabel = "seconds", .yLabel = "m", .isLogarithmic = true};
  height.series.push_back({"flight", timesS, {}});
  for (const double timeS : timesS) height.series[0].y.push_back(flightHeightM(std::fmod(timeS, kFlightHalfS)));
  report.plots = {std::move(cost), std::move(size), std::move(height)};
}

SuiteReport selectorReport(const std::vector<Flyer>& flyers, const std::vector<double>& timesS) {
  SuiteReport report{
      .name = "selector",
      .title = "The selector",
      .introduction =
          "A flight over the plain and over the mountains of the database, from 30 m to 10,000 "
          "m above the ground, with turns and pitches. Every fixed depth map and both modes "
          "of the selector draw the same frames in turn, each with its own renderer, in one "
          "process. Regret is CPU time over the flight against each frame's best fixed choice "
          "in hindsight.",
  };
  std::vector<FrameTimes> fixed;
  for (const Flyer& flyer : flyers)
    if (flyer.isFixed) fixed.push_back(flyer.cpuMs);
  const std::vector<size_t> best = bestChoices(fixed, kReach);
  FrameTimes bestMs;
  for (size_t i = 0; i < best.size(); ++i) bestMs.push_back(fixed[best[i]][i]);

  const FrameTimes& off = fixed.front();
  ReportTable table{.caption = "Modes and fixed choices",
                    .groups = {{"", 1}, {"a frame", 2}, {"against", 3}, {"share of frames with", 5}},
                    .columns = {"mode", "CPU ms", "wall ms", "best (regret)", "off", "off, worst 600 frames"}};
  for (int i = 0; i <= static_cast<int>(kDepthMapSizes); ++i)
    table.columns.emplace_back(nameOf(static_cast<DepthMapChoice>(i)));
  for (const Flyer& flyer : flyers) {
    const double lost = regret(flyer.cpuMs, fixed, best), worst = worstLoss(flyer.cpuMs, off, kTenSeconds);
    const double againstOff = mean(flyer.cpuMs) / mean(off) - 1;
    const nlohmann::ordered_json used = usedShares(flyer);
    report.rows.push_back({{"mode", flyer.mode},
                           {"cpu_ms", mean(flyer.cpuMs)},
                           {"regret", lost},
                           {"frame_ms", mean(flyer.frameMs)},
                           {"against_off", againstOff},
                           {"worst_600_frames_loss", worst},
                           {"used", used}});
    std::vector<std::string> row{
        flyer.mode,    fmt::format("{:.2f}", mean(flyer.cpuMs)),   fmt::format("{:.2f}", mean(flyer.frameMs)),
        percent(lost), fmt::format("{:+.1f} %", 100 * againstOff), fmt::format("{:+.1f} %", 100 * worst)};
    for (const auto& [name, share] : used.items()) row.push_back(fmt::format("{:.0f} %", 100 * share.get<double>()));
    table.rows.push_back(std::move(row));
    if (flyer.isFixed) continue;
    report.summary[flyer.mode + "_regret"] = lost;
    if (flyer.mode != "adaptive") continue;
    report.summary["worst_600_frames_loss"] = worst;
    report.targets = {{fmt::format("Regret of the adaptive mode (at most {:.0f} %)", 100 * kMostRegret), percent(lost),
                       lost <= kMostRegret},
                      {fmt::format("Worst loss of the adaptive mode against off over any {} frames (at most {:.0f} %)",
                                   kTenSeconds, 100 * kMostLoss),
                       percent(worst), worst <= kMostLoss}};
  }
  report.summary["frames"] = best.size();
  report.tables.push_back(std::move(table));
  addPlots(flyers, timesS, bestMs, report);
  return report;
}

}  // namespace

Result<SuiteReport> runSelectorSuite(const SuiteOptions& options) {
  const Result<DatabaseReader> reader =
      DatabaseReader::open(options.terrain.empty() ? defaultTerrainPath() : options.terrain);
  if (!reader) return tl::unexpected(reader.error());
  const auto places = findPlaces(*reader);
  if (!places) return tl::unexpected(places.error());
  GroundHeights ground(*reader);
  const Result<SelectorFlight> flight = makeSelectorFlight(*places, ground);
  if (!flight) return tl::unexpected(flight.error());
  Result<std::vector<Flyer>> flyers = makeFlyers(options);
  if (!flyers) return tl::unexpected(flyers.error());

  const double everyS = options.quick ? kQuickBurstEveryS : kBurstEveryS;
  for (int i = 0; i < kWarmFrames; ++i)
    if (const auto flown = flyFrame(*flyers, flight->at(0), 0, false); !flown) return tl::unexpected(flown.error());
  std::vector<double> timesS;
  size_t turn = 0;
  for (double burstS = 0; burstS < kFlightS; burstS += everyS) {
    if (options.progress) options.progress(fmt::format("{:.0f} s of {:.0f} s", burstS, kFlightS), burstS / kFlightS);
    for (int i = 0; i < kBurstFrames; ++i) {
      const double timeS = burstS + i * kFrameS;
      const bool counts = i > 0;
      if (counts) timesS.push_back(timeS);
      if (const auto flown = flyFrame(*flyers, flight->at(timeS), turn++, counts); !flown)
        return tl::unexpected(flown.error());
    }
  }
  SuiteReport report = selectorReport(*flyers, timesS);
  report.device = flyers->front().generator->generator().renderer().device().name;
  report.notes = {
      fmt::format("The ten minutes are sampled by bursts of {} frames at 60 Hz every {} s; the first frame of a burst "
                  "takes in the chunks of the jump and is not counted. The selector sees every frame, so the flight "
                  "changes {:.0f} times faster for it than at 60 Hz.",
                  kBurstFrames, everyS, everyS / kFrameS / kBurstFrames),
      fmt::format("A frame's best choice is the one with the least median over it and {} counted frames before and "
                  "behind; it is charged the time that it took in that very frame.",
                  kReach),
      "CPU time is that of the whole process. The best choice of a noisy table is partly luck, so that regret errs on "
      "the high side; over 600 frames the noise is well below a percent."};
  return report;
}

}  // namespace eye
