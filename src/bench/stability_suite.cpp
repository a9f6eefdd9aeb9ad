// Suite `stability`: figures at the edges, each with its limit.
#include <algorithm>

#include <fmt/format.h>

#include "bench/stability.h"
#include "bench/suites.h"

namespace eye {
namespace {

constexpr int kSamples = 200'000, kQuickSamples = 2000;
constexpr ClockEffort kQuickClocks{.sunStepsPerS = 1, .filterSteps = 100'000};
constexpr FrameEffort kQuickFrames{.stillFrames = 50, .millimetres = 10, .wildFrames = 360};

ReportTable tableOf(const std::vector<StabilityFigure>& figures) {
  ReportTable table{.caption = "Figures and their limits", .columns = {"case", "figure", "limit", "unit", "holds"}};
  for (const StabilityFigure& figure : figures)
    table.rows.push_back({figure.name, fmt::format("{:.3g}", figure.figure), fmt::format("{:g}", figure.limit),
                          figure.unit, figure.holds() ? "yes" : "NO"});
  return table;
}

}  // namespace

Result<SuiteReport> runStabilitySuite(const SuiteOptions& options) {
  constexpr double kSteps = 8;
  double done = 0;
  const auto begin = [&](const std::string& what) {
    if (options.progress) options.progress(what, done++ / kSteps);
  };
  Options generator;
  generator.terrain = options.terrain;
  generator.device = options.device;
  Result<FrameFigures> frames = frameFigures(generator, options.quick ? kQuickFrames : FrameEffort{}, begin);
  if (!frames) return tl::unexpected(frames.error());
  std::vector<StabilityFigure> figures = std::move(frames->figures);
  begin("vertices in floats and doubles");
  const std::vector<StabilityFigure> vertices = vertexFigures(options.quick ? kQuickSamples : kSamples);
  figures.insert(figures.end(), vertices.begin(), vertices.end());
  begin("clocks and filters");
  const std::vector<StabilityFigure> clocks = clockFigures(options.quick ? kQuickClocks : ClockEffort{});
  figures.insert(figures.end(), clocks.begin(), clocks.end());

  SuiteReport report{.name = "stability",
                     .title = "Numerical stability",
                     .introduction =
                         "How far pictures, vertices, clocks and filters stray at the edges of what may be "
                         "asked: heights, poles, lenses, long runs, states that no aircraft survives."};
  report.device = frames->device;
  const auto failures = std::ranges::count_if(figures, [](const StabilityFigure& figure) { return !figure.holds(); });
  report.summary["failures"] = failures;
  for (const StabilityFigure& figure : figures)
    report.rows.push_back({{"case", figure.name},
                           {"figure", figure.figure},
                           {"limit", figure.limit},
                           {"unit", figure.unit},
                           {"holds", figure.holds()}});
  report.targets.push_back({"Figures within their limits",
                            fmt::format("{} of {}", figures.size() - static_cast<size_t>(failures), figures.size()),
                            failures == 0});
  report.tables.push_back(tableOf(figures));
  report.notes = {
      "Vertices: the vertex shader's arithmetic repeated in floats on the CPU against doubles, at random "
      "views; 1,280 pixels wide. Limits of pixels: a tenth, which nobody sees."};
  return report;
}

}  // namespace eye
