// What the benchmark writes: report.json for programs, report.html for people.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "bench/machine_speed.h"

namespace eye {

// A table as a page shows it; cells are text, the first column's on the left, numbers on the right.
struct ReportTable {
  struct Group {
    std::string name{};
    size_t columns = 1;
  };
  std::string caption{};
  std::vector<Group> groups{};  // above the columns; empty: none
  std::vector<std::string> columns{};
  std::vector<std::vector<std::string>> rows{};
  bool isPrinted = false;  // the program shows it too
};

struct Series {
  std::string name{};
  std::vector<double> x{}, y{};       // lines: points; bars: y by category, x empty. Not finite: left out
  bool areDots = false;               // the points by themselves instead of the line through them
  double dotPx = 2.5;                 // radius
  std::vector<std::string> labels{};  // of the dots, shown under the pointer
};

struct ReportPlot {
  std::string title{}, xLabel{}, yLabel{};
  std::vector<std::string> categories{};  // not empty: grouped bars
  bool isLogarithmic = false;             // the y axis; values above 0
  bool isLogarithmicX = false;
  bool isFromZero = true;  // a linear y axis
  std::vector<Series> series{};
};

struct ReportTarget {
  std::string what{}, measured{};
  bool isReached = false;
};

struct SuiteReport {
  std::string name{}, title{}, introduction{};
  nlohmann::ordered_json summary = nlohmann::ordered_json::object();
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  std::vector<ReportPlot> plots{};
  MachineSpeed speed{};        // while it ran
  double wallS = 0, cpuS = 0;  // that it took
  // For the page alone.
  std::string device{};  // that drew
  std::vector<ReportTarget> targets{};
  std::vector<ReportTable> tables{};
  std::vector<std::string> notes{};  // how to read it
};

struct Report {
  std::string machine{}, device{}, commit{}, settings{};
  std::vector<SuiteReport> suites{};
};

std::string machineLine();  // "AMD EPYC ..., 2 cores"
std::string loadLine();     // of the last minute: what else the machine does

std::string reportJson(const Report& report);
std::string reportHtml(const Report& report);
std::string tableText(const ReportTable& table);  // aligned columns, for a terminal
// An inline picture, readable on light and on dark pages.
std::string plotSvg(const ReportPlot& plot);
// The same as a file of its own, with its title.
std::string plotPicture(const ReportPlot& plot);
std::string escapeHtml(const std::string& text);

// Both files into a folder, which is made where it is missing.
Result<void> writeReport(const Report& report, const std::string& folder);

}  // namespace eye
