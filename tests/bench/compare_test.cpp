// Reports held against baselines: what is the same, what is not, and files that are neither.
#include <unistd.h>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "bench/compare.h"
#include "bench/plot_json.h"

namespace eye {
namespace {

using Json = nlohmann::ordered_json;

// Counts of four schemes at one height; times in a machine's own milliseconds.
Json report(double slowness) {
  Json rows = Json::array();
  const auto row = [&](const char* scheme, double triangles, double cpuMs) {
    rows.push_back({{"altitude_ft", 2000},
                    {"scheme", scheme},
                    {"size", "800x600"},
                    {"place", "plain"},
                    {"triangles", triangles},
                    {"cpu_ms", cpuMs * slowness}});
  };
  row("none", 300'000, 60);
  row("frustum", 100'000, 20);
  row("dynamic", 31'000, 15);
  row("dynamic_320x240", 30'000, 14);
  return {{"machine", "m"},
          {"device", "d"},
          {"settings", "/here/x.eyt, quick"},
          {"suites",
           {{"culling",
             {{"summary", Json::object()},
              {"rows", rows},
              {"speed", {{"loop_ms", 10 * slowness}, {"draw_ms", 5 * slowness}}}}}}}};
}

Figures figures(const Json& json) {
  const Result<Figures> made = figuresOf(json, "test");
  INFO((made ? std::string() : made.error().message));
  REQUIRE(made);
  return *made;
}

Comparison compared(const Json& now, const Json& then) {
  const Result<Comparison> made = compare(figures(now), figures(then));
  REQUIRE(made);
  return *made;
}

const ComparedFigure& find(const Comparison& comparison, const std::string& part) {
  for (const ComparedFigure& figure : comparison.figures)
    if (figure.figure.name.find(part) != std::string::npos) return figure;
  FAIL("no figure " << part);
  return comparison.figures.front();
}

std::string message(const Json& json) {
  const Result<Figures> made = figuresOf(json, "x.json");
  REQUIRE_FALSE(made);
  CHECK(made.error().message.find("x.json") == 0);
  CHECK(made.error().message.find('\n') == std::string::npos);
  return made.error().message;
}

struct Folder {
  std::filesystem::path path = std::filesystem::temp_directory_path() / ("eye_compare_" + std::to_string(getpid()));
  Folder() { std::filesystem::create_directories(path); }
  ~Folder() { std::filesystem::remove_all(path); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path / name) << text;
    return path / name;
  }
};

}  // namespace

TEST_CASE("A machine of half the speed is the same run; what a clock chose is left out") {
  const Comparison same = compared(report(2), report(1));
  CHECK(same.isSame());
  CHECK(same.figures.size() == 3 + 3);  // triangles and times of none, frustum and the fixed map
  for (const ComparedFigure& figure : same.figures) CHECK(figure.figure.name.find("dynamic,") == std::string::npos);
}

TEST_CASE("A count that is off by one, a time off by more than its band, a figure that is gone") {
  Json now = report(1);
  Json& rows = now["suites"]["culling"]["rows"];
  rows[1]["triangles"] = 100'001;
  rows[0]["cpu_ms"] = 60 * 1.39;
  rows[3]["cpu_ms"] = 14 * 1.42;
  rows[3]["triangles"] = 30'500;
  Comparison off = compared(now, report(1));
  CHECK_FALSE(off.isSame());
  CHECK(find(off, "triangles, place plain, altitude_ft 2000, size 800x600, scheme frustum").verdict == Verdict::off);
  CHECK(find(off, "cpu_ms, size 800x600, scheme none").verdict == Verdict::same);
  CHECK(find(off, "cpu_ms, size 800x600, scheme dynamic_320x240").verdict == Verdict::slower);
  CHECK(find(off, "scheme dynamic_320x240").verdict == Verdict::same);  // its triangles hang on drawn depths
  const std::string text = comparisonText(off);
  CHECK(text.find("NOT THE SAME") != std::string::npos);
  CHECK(text.find("SLOWER") != std::string::npos);
  CHECK(text.find("exact") != std::string::npos);
  CHECK(text.find("+42.0 %") != std::string::npos);

  rows = report(1)["suites"]["culling"]["rows"];
  rows.erase(1);
  off = compared(now, report(1));
  CHECK_FALSE(off.isSame());
  CHECK(find(off, "scheme frustum").verdict == Verdict::missing);
}

TEST_CASE("Faster, and new figures, are told and are no fault") {
  Json now = report(1);
  now["suites"]["culling"]["rows"][0]["cpu_ms"] = 30;
  now["suites"]["stability"] = {{"summary", Json::object()}, {"rows", {{{"case", "still eye"}, {"holds", true}}}}};
  const Comparison better = compared(now, report(1));
  CHECK(better.isSame());
  CHECK(find(better, "cpu_ms, size 800x600, scheme none").verdict == Verdict::faster);
  CHECK(find(better, "still eye").verdict == Verdict::added);
  CHECK(find(better, "still eye").now == 1);
}

TEST_CASE("Runs of other settings are not compared; the terrain's folder does not matter") {
  Json other = report(1);
  other["settings"] = "/elsewhere/x.eyt, quick";
  CHECK(compared(report(1), other).isSame());
  other["settings"] = "/here/x.eyt";
  const Result<Comparison> refused = compare(figures(report(1)), figures(other));
  REQUIRE_FALSE(refused);
  CHECK(refused.error().message.find("x.eyt, quick") != std::string::npos);
}

TEST_CASE("A baseline keeps what a report says") {
  const Figures kept = figures(Json::parse(baselineJson(figures(report(1)))));
  CHECK(kept.settings == "/here/x.eyt, quick");
  const Result<Comparison> again = compare(figures(report(1)), kept);
  REQUIRE(again);
  CHECK(again->isSame());
  CHECK(again->figures.size() == 6);
}

TEST_CASE("JSON that is neither report nor baseline is told in one line") {
  CHECK(message(Json::array()).find("neither") != std::string::npos);
  CHECK(message({{"suites", 3}}).find("neither") != std::string::npos);
  CHECK(message({{"suites", {{"culling", 3}}}}).find("culling: it is no object") != std::string::npos);
  CHECK(message({{"suites", {{"culling", Json::object()}}}}).find("'rows' is missing") != std::string::npos);
  CHECK(message({{"suites", {{"culling", {{"rows", 3}}}}}}).find("'rows' is no list") != std::string::npos);
  Json old = report(1);
  old["suites"]["culling"].erase("speed");
  CHECK(message(old).find("no 'speed'") != std::string::npos);
  old["suites"]["culling"]["rows"][0] = 7;
  CHECK(message(old).find("no object") != std::string::npos);
  CHECK(message({{"figures", {{"a", {{"value", "x"}, {"band", 0}, {"kind", "count"}}}}}}).find("'a'") !=
        std::string::npos);
  CHECK(message({{"figures", {{"a", {{"value", 1}, {"band", -1}, {"kind", "count"}}}}}}).find("'a'") !=
        std::string::npos);
  CHECK(message({{"figures", {{"a", {{"value", 1}, {"band", 0}, {"kind", "guess"}}}}}}).find("kinds") !=
        std::string::npos);
}

TEST_CASE("Files: compared, updated, missing, broken, a folder") {
  const Folder folder;
  const std::string now = folder.write("report.json", report(1).dump()), kept = folder.path / "kept.json";
  REQUIRE(compareFiles(now, kept, true));
  CHECK(compareFiles(now, kept, false));
  Json changed = report(1);
  changed["suites"]["culling"]["rows"][1]["triangles"] = 5;
  const Result<void> off = compareFiles(folder.write("changed.json", changed.dump()), kept, false);
  REQUIRE_FALSE(off);
  CHECK(exitStatus(off.error()) == 1);
  CHECK(off.error().message.find("1 of 6") != std::string::npos);
  const auto refusal = [&](const std::string& path) {
    const Result<void> refused = compareFiles(path, kept, false);
    REQUIRE_FALSE(refused);
    return refused.error().message;
  };
  CHECK(refusal(folder.path / "none.json").find("none.json: cannot be read") != std::string::npos);
  CHECK(refusal(folder.write("cut.json", report(1).dump().substr(0, 90))).find("no JSON") != std::string::npos);
  CHECK(refusal(folder.path).find("is a folder") != std::string::npos);
  CHECK_FALSE(compareFiles(folder.write("empty.json", R"({"suites":{}})"), kept, true));
}

TEST_CASE("The numbers behind a plot, as CSV") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  ReportPlot bars{.xLabel = "feet, above ground", .categories = {"98", "say \"2,000\""}};
  bars.series = {{"none", {}, {10, 20}}, {"dynamic", {}, {nan}}};
  CHECK(plotCsv(bars) == "\"feet, above ground\",none,dynamic\n98,10,\n\"say \"\"2,000\"\"\",20,\n");
  ReportPlot lines{.xLabel = "s", .yLabel = "m"};
  lines.series = {{"a", {1, 2}, {3, nan}}};
  CHECK(plotCsv(lines) == "series,s,m\na,1,3\na,2,\n");
}

TEST_CASE("Plots come out of a report as they went in; one that is broken is named") {
  ReportPlot plot{.title = "t <1>", .xLabel = "x", .yLabel = "y", .categories = {"a"}, .isLogarithmic = true};
  plot.series = {{"s", {1, 2}, {3, std::numeric_limits<double>::quiet_NaN()}, true}};
  const auto again = plotsOf(plotsJson({plot}), "r");
  REQUIRE(again);
  CHECK(plotPicture(again->front()) == plotPicture(plot));
  CHECK(again->front().series[0].areDots);
  CHECK(std::isnan(again->front().series[0].y[1]));

  Json broken = plotsJson({plot, plot});
  broken[1].erase("title");
  const auto refused = plotsOf(broken, "r");
  REQUIRE_FALSE(refused);
  CHECK(refused.error().message.find("r: plot 2") == 0);

  const Folder folder;
  Json json{{"suites", {{"../evil", {{"plots", plotsJson({plot})}}}, {"old", {{"rows", Json::array()}}}}}};
  const std::string pictures = folder.path / "pictures";
  REQUIRE(writePlots(folder.write("report.json", json.dump()), pictures));
  CHECK(std::filesystem::exists(pictures + "/evil-1.svg"));
  CHECK(std::filesystem::exists(pictures + "/evil-1.csv"));
  CHECK(std::distance(std::filesystem::directory_iterator(pictures), {}) == 2);
  CHECK_FALSE(writePlots(folder.write("bad.json", "[1]"), pictures));
}

}  // namespace eye
