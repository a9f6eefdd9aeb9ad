// The report's two files.
#include <limits>

#include <unistd.h>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "bench/report.h"

namespace eye {
namespace {

Report hostileReport() {
  SuiteReport suite{.name = "culling", .title = "A <b>title</b> & more", .introduction = "\"quoted\" 'too'"};
  suite.summary["saved"] = std::numeric_limits<double>::quiet_NaN();
  suite.rows.push_back({{"scheme", "none"}, {"published_fps", nullptr}});
  suite.targets = {{"aim <1>", "2 %", true}, {"aim 2", "9 %", false}};
  suite.tables.push_back(
      {.caption = "<script>", .groups = {{"g&h", 2}}, .columns = {"a", "b"}, .rows = {{"<td>", "1"}}});
  suite.notes = {"note </li>"};
  return {
      .machine = "a \"fast\" <machine>", .device = "llvmpipe", .commit = "abc", .settings = "x.eyt", .suites = {suite}};
}

size_t countOf(const std::string& text, const std::string& word) {
  size_t count = 0;
  for (size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
  return count;
}

}  // namespace

TEST_CASE("report.json has the promised shape; what is no number is null") {
  const auto json = nlohmann::json::parse(reportJson(hostileReport()));
  for (const char* key : {"machine", "device", "commit", "settings", "suites"}) CHECK(json.contains(key));
  CHECK(json["machine"] == "a \"fast\" <machine>");
  const auto& suite = json["suites"]["culling"];
  CHECK(suite["summary"]["saved"].is_null());
  CHECK(suite["rows"].size() == 1);
  CHECK(suite["rows"][0]["published_fps"].is_null());
}

TEST_CASE("report.html escapes all that it is given and needs no other file") {
  CHECK(escapeHtml("a<b>&\"'") == "a&lt;b&gt;&amp;&quot;&#39;");
  const std::string html = reportHtml(hostileReport());
  for (const char* raw : {"<script>", "<b>title", "<machine>", "note </li></li>", "aim <1>", "<td><td>"})
    CHECK(countOf(html, raw) == 0);
  CHECK(countOf(html, "&lt;script&gt;") == 1);
  CHECK(countOf(html, "<li class=\"reached\"") == 1);
  CHECK(countOf(html, "<li class=\"missed\"") == 1);
  CHECK(countOf(html, "1 of 2 aims reached") == 1);
  for (const char* outside : {"http:", "https:", "src=", "@import"}) CHECK(countOf(html, outside) == 0);
  CHECK(countOf(html, "href=\"#") == countOf(html, "href="));
  CHECK(countOf(html, "href=\"#culling\"") == 1);
  CHECK(countOf(html, "id=\"culling\"") == 1);
}

TEST_CASE("Plots draw every value that there is, inside of the picture") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  ReportPlot bars{.title = "<t>", .categories = {"98", "984"}};
  bars.series = {{"none", {}, {10, 20}}, {"dynamic", {}, {5, nan}}};
  const std::string svg = plotSvg(bars);
  CHECK(countOf(svg, "<title>") == 3);
  CHECK(countOf(svg, "nan") == 0);
  CHECK(countOf(svg, "&lt;t&gt;") == 1);

  ReportPlot lines{.title = "lines", .isLogarithmic = true};
  lines.series = {{"height", {0, 1, 2, 3}, {30, 0, nan, 10000}}};
  const std::string drawn = plotSvg(lines);
  const size_t at = drawn.find("points=\"") + 8;
  CHECK(countOf(drawn.substr(at, drawn.find('"', at) - at), ",") == 2);
  CHECK(countOf(drawn, "nan") == 0);
  CHECK(countOf(plotSvg({.title = "nothing"}), "<svg") == 1);
}

TEST_CASE("Both files are written into a folder that is made, or the error says where") {
  const auto folder = std::filesystem::temp_directory_path() / ("eye_report_" + std::to_string(getpid())) / "deep";
  REQUIRE(writeReport(hostileReport(), folder));
  CHECK(std::filesystem::file_size(folder / "report.json") > 100);
  CHECK(std::filesystem::file_size(folder / "report.html") > 1000);
  std::filesystem::remove_all(folder.parent_path());
  const auto refused = writeReport(hostileReport(), "/proc/nowhere");
  REQUIRE_FALSE(refused);
  CHECK(refused.error().message.find("/proc/nowhere") != std::string::npos);
}

TEST_CASE("The machine has a name and cores") {
  CHECK(machineLine().find(" cores") != std::string::npos);
}

}  // namespace eye
