// Regret and losses by hand.
#include <cmath>

#include <catch2/catch.hpp>

#include "bench/culling_rows.h"
#include "bench/regret.h"

namespace eye {

TEST_CASE("Regret is against each frame's best choice") {
  const std::vector<FrameTimes> fixed{{10, 10, 10, 10}, {8, 8, 12, 12}};
  const std::vector<size_t> best = bestChoices(fixed, 0);
  CHECK(best == std::vector<size_t>{1, 1, 0, 0});
  CHECK(regret({8, 8, 10, 10}, fixed, best) == Approx(0).margin(1e-12));
  CHECK(regret(fixed[0], fixed, best) == Approx(40.0 / 36 - 1));
  CHECK(regret(fixed[1], fixed, best) == Approx(40.0 / 36 - 1));
}

TEST_CASE("One lucky frame makes no choice the best") {
  const std::vector<FrameTimes> fixed{{10, 10, 10, 10, 10}, {11, 11, 2, 11, 11}};
  CHECK(bestChoices(fixed, 0)[2] == 1);
  CHECK(bestChoices(fixed, 1) == std::vector<size_t>(5, 0));
  CHECK(runningMedian(fixed[1], 1) == FrameTimes{11, 11, 11, 11, 11});
  CHECK(runningMedian({1, 3, 2, 8}, 1) == FrameTimes{2, 2, 3, 5});
}

TEST_CASE("The worst loss is that of the worst window, of all frames where there are few") {
  const FrameTimes mode{10, 10, 12, 12, 9, 9}, off(6, 10);
  CHECK(worstLoss(mode, off, 1) == Approx(0.2));
  CHECK(worstLoss(mode, off, 2) == Approx(0.2));
  CHECK(worstLoss(mode, off, 3) == Approx(34.0 / 30 - 1));
  CHECK(worstLoss(mode, off, 600) == Approx(62.0 / 60 - 1));
}

TEST_CASE("What dynamic culling saves counts the place and the height that are asked for") {
  const auto cell = [](const char* place, int altitudeFt, double frustumMs, double dynamicMs) {
    CullingCell made{.place = place, .sizePx = {800, 600}, .altitudeFt = altitudeFt, .schemes = {}};
    made.schemes[1].cpuMs = frustumMs;
    made.schemes[2].cpuMs = dynamicMs;
    return made;
  };
  const std::vector<CullingCell> cells{cell("mountains", 98, 40, 20), cell("mountains", 984, 20, 16),
                                       cell("mountains", 2000, 20, 30), cell("plain", 98, 10, 11)};
  CHECK(savedCpu(cells, "dynamic", "mountains", 1000) == Approx(1 - 36.0 / 60));
  CHECK(savedCpu(cells, "dynamic", "plain", 1000) == Approx(-0.1));
  CHECK(std::isnan(savedCpu(cells, "dynamic", "sea", 1000)));
  const SuiteReport report = cullingReport(cells);
  CHECK(report.summary["saved_cpu_low_level"] == Approx(0.4));
  CHECK(report.summary["worst_loss"] == Approx(0.5));
  CHECK_FALSE(report.targets[1].isReached);
}

TEST_CASE("The noise is what differs where nothing should") {
  CullingCell off{.place = "plain", .sizePx = {800, 600}, .altitudeFt = 98, .schemes = {}};
  off.schemes[1].cpuMs = 20;
  off.schemes[2].cpuMs = 19;
  off.schemes[2].depthMaps["off"] = 1;
  CullingCell mapped = off;
  mapped.schemes[2].cpuMs = 10;
  mapped.schemes[2].depthMaps = {{"320x240", 0.5}, {"off", 0.5}};
  CHECK(measurementNoise({off, mapped}) == Approx(0.05));
  CHECK(std::isnan(measurementNoise({mapped})));
}

TEST_CASE("Views are averaged") {
  SchemeFigures mean, view;
  view.cpuMs = 10;
  view.passMs["late"] = 4;
  addView(view, 2, mean);
  view.cpuMs = 20;
  addView(view, 2, mean);
  CHECK(mean.cpuMs == Approx(15));
  CHECK(mean.passMs["late"] == Approx(4));
}

}  // namespace eye
