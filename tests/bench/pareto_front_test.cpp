// Which settings lie on the front, and what a median is worth.
#include <catch2/catch.hpp>

#include "bench/pareto_report.h"

namespace eye {

TEST_CASE("on the front is what none beats in cost and in every error") {
  const std::vector<ParetoPoint> points{{1, 0, {3, 1}}, {2, 0, {2, 1}}, {3, 0, {2.5, 1}}, {4, 0, {2.5, 0.5}}};
  CHECK(onFront(points) == std::vector<bool>{true, true, false, true});
}

TEST_CASE("within the spread of the measurement nothing is beaten") {
  std::vector<ParetoPoint> points{{1.00, 0.01, {2}}, {1.05, 0.01, {2}}};
  CHECK(onFront(points) == std::vector<bool>{true, false});
  points[0].spread = 0.03;
  CHECK(onFront(points) == std::vector<bool>{true, true});
  points[1].errors = {1.9};  // better, and dearer: both
  points[0].spread = 0;
  CHECK(onFront(points) == std::vector<bool>{true, true});
}

TEST_CASE("what is cheaper by less than a choice is worth beats nothing") {
  std::vector<ParetoPoint> points{{1.00, 0, {2}}, {1.015, 0, {2}}};
  CHECK(onFront(points) == std::vector<bool>{true, true});
  points[1].cost = 1.025;
  CHECK(onFront(points) == std::vector<bool>{true, false});
}

TEST_CASE("a median's spread is that of a box plot's notch") {
  const SpreadMedian nine = spreadMedian({9, 1, 8, 2, 7, 3, 6, 4, 5});
  CHECK(nine.median == 5);
  CHECK(nine.spread == Approx(1.57 * 4 / 3));
  CHECK(spreadMedian({3, 3, 3}).spread == 0);
  CHECK(spreadMedian({1, 2}).median == 1.5);
}

TEST_CASE("the front of settings is one for each size, and the report says where the default is") {
  const auto result = [](const ParetoSetting& setting, double ratio, double p99, double psnr) {
    return ParetoResult{.setting = setting,
                        .samplerName = "bilinear",
                        .cpuMs = 10 * ratio,
                        .cpuAgainstDefault = {ratio, 0.01},
                        .explained = 1,
                        .distanceP99 = p99,
                        .psnrDb = psnr};
  };
  std::vector<ParetoResult> results{result({}, 1, 1e-3, 35), result({.ssePx = 2}, 0.8, 2e-3, 33),
                                    result({.culling = CullingMode::none}, 1.5, 1e-3, 35),
                                    result({.sizePx = {1280, 720}}, 1, 1e-4, 40)};
  CHECK(paretoFront(results) == std::vector<bool>{true, true, false, true});
  SuiteReport report;
  addPareto(results, "a test", report);
  CHECK(report.summary["default_on_front"] == true);
  results[1].distanceP99 = 1e-3;
  results[1].psnrDb = 35;
  SuiteReport beaten;
  addPareto(results, "a test", beaten);
  CHECK(beaten.summary["default_on_front"] == false);
  CHECK(beaten.rows[0]["on_front"] == false);
  CHECK(plotSvg(report.plots[0]).find("default: 10.00 ms") != std::string::npos);
}

}  // namespace eye
