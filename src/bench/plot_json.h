// Plots as report.json holds them, so that pictures can be made of a report later.
#pragma once

#include "bench/report.h"

namespace eye {

nlohmann::ordered_json plotsJson(const std::vector<ReportPlot>& plots);
// badData names the key that is missing or of the wrong kind; `where` says whose it is.
Result<std::vector<ReportPlot>> plotsOf(const nlohmann::ordered_json& json, const std::string& where);

// The numbers behind a plot: a column a series of bars, a row a point of lines.
std::string plotCsv(const ReportPlot& plot);

// `eyepoint-bench plots`: every plot of a report as FOLDER/SUITE-N.svg, pictures of their own, and SUITE-N.csv beside.
Result<void> writePlots(const std::string& reportPath, const std::string& folder);

}  // namespace eye
