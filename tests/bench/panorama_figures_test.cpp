#include <map>

#include <catch2/catch.hpp>

#include "bench/panorama_report.h"
#include "bench/small_database.h"
#include "bench/summit_places.h"

namespace eye {

TEST_CASE("Distance figures: by hand") {
  const std::array<DistancePair, 4> pairs{{{1040, 1000}, {1800, 2000}, {3000, 3000}, {4920, 4000}}};
  const DistanceFigures f = distanceFigures(pairs);
  CHECK(f.peaks == 4);
  CHECK(f.within[0] == 0.5);  // 0 and 4 %
  CHECK(f.within[1] == 0.5);  // 10 % is not below 10 %
  CHECK(f.within[2] == 0.75);
  CHECK(f.within[4] == 1);  // 23 %
  CHECK(f.mape == Approx((0.04 + 0.1 + 0.23) / 4));
  CHECK(f.rmseM == Approx(std::sqrt((1600.0 + 40000 + 846400) / 4)));
  CHECK(f.relativeSquaredError == Approx(888000.0 / 5e6));  // of what the mean, 2,500 m, would do
  CHECK(f.r2 == Approx(1 - 888000.0 / 5e6));
}

TEST_CASE("Regression: a line is taken out, by folds that had no part in it") {
  std::vector<DistancePair> pairs;
  for (int i = 0; i < 42; ++i) pairs.push_back({1000.0 * i + 500, 0.9 * (1000.0 * i + 500) - 100});
  const std::optional<std::vector<DistancePair>> line = withRegression(pairs);
  REQUIRE(line);
  for (const DistancePair& pair : *line) CHECK(pair.toldM == Approx(pair.trueM).margin(1e-6));
  // One that lies: its own line would follow it, the others' does not.
  pairs[3].trueM += 5000;
  const auto corrected = withRegression(pairs).value();
  CHECK(corrected[3].toldM == Approx(0.9 * pairs[3].toldM - 100).margin(1e-6));
  CHECK_FALSE(withRegression(std::span(pairs).first(13)));  // too few
  CHECK(withRegression(std::span(pairs).first(14)));
}

TEST_CASE("Summits of the terrain itself: the highest first, apart, and places to see them from") {
  const auto reader = DatabaseReader::open(smallDatabase());
  REQUIRE(reader);
  const auto summits = terrainSummits(*reader, 20);
  REQUIRE(summits);
  REQUIRE(summits->size() == 20);
  CHECK(summits->front().heightM.value() > 1000);
  for (size_t i = 1; i < summits->size(); ++i)
    CHECK((*summits)[i].heightM.value() <= (*summits)[i - 1].heightM.value());

  auto ground = GroundQuery::open(smallDatabase());
  REQUIRE(ground);
  const auto viewpoints = summitViewpoints(*summits, {.mountains = 1, .valleys = 1}, *ground);
  REQUIRE(viewpoints);
  REQUIRE(viewpoints->size() == 3);
  for (const Viewpoint& viewpoint : *viewpoints) {
    const auto under = ground->under(viewpoint.eye.latDeg, viewpoint.eye.lonDeg);
    REQUIRE(under);
    CHECK(viewpoint.eye.altM == Approx(under->position.altM + 2));
    CHECK(under->position.altM > 1);  // not on the sea outside of the data
  }
  CHECK((*viewpoints)[0].eye.altM > (*viewpoints)[1].eye.altM);
  CHECK((*viewpoints)[1].eye.altM > (*viewpoints)[2].eye.altM);
}

TEST_CASE("Panorama report: too few peaks for a line are said to be too few, and both truths are told") {
  std::vector<MeasuredPeak> peaks;
  for (int i = 0; i < 20; ++i) {
    MeasuredPeak peak{.name = "p", .viewpoint = "v", .isAboveEye = i < 5};
    peak.trueM = 5000.0 + 1000 * i, peak.groundM = 1.01 * peak.trueM;
    peak.toldM.fill(peak.groundM);
    peaks.push_back(peak);
  }
  const SuiteReport report = panoramaReport(peaks, 1);
  const std::string page = reportHtml({.suites = {report}});
  CHECK(page.find("no line: 5 peaks, and it takes 14") != std::string::npos);
  std::map<std::string, nlohmann::ordered_json> rows;
  for (const auto& row : report.rows)
    rows[row["method"].get<std::string>() + " " + row["camera"].get<std::string>()] = row;
  CHECK_FALSE(rows.contains("range lower_regression"));
  REQUIRE(rows.contains("range all_regression"));
  CHECK(rows["range all"]["mape"].get<double>() == Approx(0.01));
  CHECK(rows["range_against_terrain all"]["mape"].get<double>() == Approx(0).margin(1e-9));
  CHECK(report.summary["peaks_camera_lower"] == 5);
}

}  // namespace eye
