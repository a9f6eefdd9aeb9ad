#include "bench/plot_json.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "bench/read_json.h"

namespace eye {
namespace {

using Json = nlohmann::ordered_json;

// What is not finite is null in JSON.
Json valuesJson(const std::vector<double>& values) {
  Json json = Json::array();
  for (const double value : values) json.push_back(std::isfinite(value) ? Json(value) : Json(nullptr));
  return json;
}

// Throws nlohmann's exceptions; plotsOf turns them into an Error.
std::vector<double> valuesOf(const Json& json) {
  std::vector<double> values;
  for (const Json& value : json) values.push_back(value.is_null() ? NAN : value.get<double>());
  return values;
}

ReportPlot plotOf(const Json& json) {
  ReportPlot plot;
  json.at("title").get_to(plot.title);
  json.at("x_label").get_to(plot.xLabel);
  json.at("y_label").get_to(plot.yLabel);
  json.at("categories").get_to(plot.categories);
  json.at("logarithmic").get_to(plot.isLogarithmic);
  json.at("logarithmic_x").get_to(plot.isLogarithmicX);
  json.at("from_zero").get_to(plot.isFromZero);
  for (const Json& series : json.at("series"))
    plot.series.push_back({.name = series.at("name").get<std::string>(),
                           .x = valuesOf(series.at("x")),
                           .y = valuesOf(series.at("y")),
                           .areDots = series.at("dots").get<bool>(),
                           .dotPx = series.at("dot_px").get<double>(),
                           .labels = series.at("labels").get<std::vector<std::string>>()});
  return plot;
}

// A cell of CSV: quoted where it has to be.
std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted(1, '"');
  for (const char c : text) quoted.append(c == '"' ? 2 : 1, c);
  quoted.push_back('"');
  return quoted;
}

std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.6g}", value) : "";
}

Result<void> writeText(const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (file) return {};
  return fail(ErrorKind::io, fmt::format("{}: cannot write: {}", path, std::strerror(errno)));
}

}  // namespace

std::string plotCsv(const ReportPlot& plot) {
  std::string csv;
  if (plot.categories.empty()) {
    csv = fmt::format("series,{},{}\n", cell(plot.xLabel), cell(plot.yLabel));
    for (const Series& series : plot.series)
      for (size_t i = 0; i < std::min(series.x.size(), series.y.size()); ++i)
        csv += fmt::format("{},{},{}\n", cell(series.name), number(series.x[i]), number(series.y[i]));
    return csv;
  }
  csv = cell(plot.xLabel);
  for (const Series& series : plot.series) csv += fmt::format(",{}", cell(series.name));
  csv += "\n";
  for (size_t i = 0; i < plot.categories.size(); ++i) {
    csv += cell(plot.categories[i]);
    for (const Series& series : plot.series) csv += fmt::format(",{}", i < series.y.size() ? number(series.y[i]) : "");
    csv += "\n";
  }
  return csv;
}

nlohmann::ordered_json plotsJson(const std::vector<ReportPlot>& plots) {
  Json json = Json::array();
  for (const ReportPlot& plot : plots) {
    Json series = Json::array();
    for (const Series& one : plot.series)
      series.push_back({{"name", one.name},
                        {"dots", one.areDots},
                        {"dot_px", one.dotPx},
                        {"labels", one.labels},
                        {"x", valuesJson(one.x)},
                        {"y", valuesJson(one.y)}});
    json.push_back({{"title", plot.title},
                    {"x_label", plot.xLabel},
                    {"y_label", plot.yLabel},
                    {"categories", plot.categories},
                    {"logarithmic", plot.isLogarithmic},
                    {"logarithmic_x", plot.isLogarithmicX},
                    {"from_zero", plot.isFromZero},
                    {"series", series}});
  }
  return json;
}

Result<std::vector<ReportPlot>> plotsOf(const nlohmann::ordered_json& json, const std::string& where) {
  if (!json.is_array()) return fail(ErrorKind::badData, fmt::format("{}: 'plots' is no list; write it anew", where));
  std::vector<ReportPlot> plots;
  try {
    for (const Json& plot : json) plots.push_back(plotOf(plot));
  } catch (const Json::exception& problem) {
    return fail(ErrorKind::badData, fmt::format("{}: plot {} cannot be read ({}); write the report anew", where,
                                                plots.size() + 1, problem.what()));
  }
  return plots;
}

Result<void> writePlots(const std::string& reportPath, const std::string& folder) {
  const Result<Json> json = readJson(reportPath);
  if (!json) return tl::unexpected(json.error());
  const auto suites = json->is_object() ? json->find("suites") : json->end();
  if (!json->is_object() || suites == json->end() || !suites->is_object())
    return fail(ErrorKind::badData,
                fmt::format("{}: is no report.json of eyepoint-bench: it has no 'suites'", reportPath));
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed)
    return fail(ErrorKind::io,
                fmt::format("{}: cannot make this folder: {}; choose another --out", folder, failed.message()));
  for (const auto& [name, suite] : suites->items()) {
    if (!suite.is_object() || !suite.contains("plots")) continue;
    const auto plots = plotsOf(suite["plots"], fmt::format("{}: suite {}", reportPath, name));
    if (!plots) return tl::unexpected(plots.error());
    for (size_t i = 0; i < plots->size(); ++i) {
      // A suite's name is part of a path, and the report may have been written by anybody.
      const std::string file = fmt::format("{}-{}", std::filesystem::path(name).filename().string(), i + 1);
      const std::string base = (std::filesystem::path(folder) / file).string();
      if (const auto written = writeText(base + ".svg", plotPicture((*plots)[i])); !written) return written;
      if (const auto written = writeText(base + ".csv", plotCsv((*plots)[i])); !written) return written;
      fmt::print("{}.svg, .csv: {}\n", base, (*plots)[i].title);
    }
  }
  return {};
}

}  // namespace eye
