#include "bench/report.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "bench/plot_json.h"

namespace eye {
namespace {

Result<void> writeText(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (file) return {};
  return fail(ErrorKind::io, fmt::format("{}: cannot write: {}; free space or choose another --out", path.string(),
                                         std::strerror(errno)));
}

nlohmann::ordered_json jsonOf(const MachineSpeed& speed) {
  nlohmann::ordered_json json{{"loop_ms", speed.loopMs}, {"draw_ms", nullptr}};
  if (speed.drawMs) json["draw_ms"] = *speed.drawMs;
  return json;
}

}  // namespace

std::string machineLine() {
  std::string model = "unknown processor";
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    const size_t colon = line.find(": ");
    if (!line.starts_with("model name") || colon == std::string::npos) continue;
    model = line.substr(colon + 2);
    break;
  }
  return fmt::format("{}, {} cores", model, sysconf(_SC_NPROCESSORS_ONLN));
}

std::string loadLine() {
  double load = 0;
  return getloadavg(&load, 1) == 1 ? fmt::format("{:.1f}", load) : "unknown";
}

std::string reportJson(const Report& report) {
  nlohmann::ordered_json json{{"machine", report.machine},
                              {"device", report.device},
                              {"commit", report.commit},
                              {"settings", report.settings},
                              {"suites", nlohmann::ordered_json::object()}};
  for (const SuiteReport& suite : report.suites)
    json["suites"][suite.name] = {{"title", suite.title},           {"summary", suite.summary}, {"rows", suite.rows},
                                  {"speed", jsonOf(suite.speed)},   {"wall_s", suite.wallS},    {"cpu_s", suite.cpuS},
                                  {"plots", plotsJson(suite.plots)}};
  return json.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::string tableText(const ReportTable& table) {
  std::vector<size_t> widths;
  for (const std::string& column : table.columns) widths.push_back(column.size());
  for (const std::vector<std::string>& row : table.rows)
    for (size_t i = 0; i < std::min(row.size(), widths.size()); ++i) widths[i] = std::max(widths[i], row[i].size());
  const auto line = [&](const std::vector<std::string>& cells) {
    std::string text;
    for (size_t i = 0; i < std::min(cells.size(), widths.size()); ++i)
      text += i == 0 ? fmt::format("{:<{}}", cells[i], widths[i]) : fmt::format("  {:>{}}", cells[i], widths[i]);
    return text + "\n";
  };
  std::string text = table.caption + "\n" + line(table.columns);
  for (const std::vector<std::string>& row : table.rows) text += line(row);
  return text;
}

Result<void> writeReport(const Report& report, const std::string& folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed)
    return fail(ErrorKind::io,
                fmt::format("{}: cannot make this folder: {}; choose another --out", folder, failed.message()));
  const std::filesystem::path path(folder);
  if (const Result<void> written = writeText(path / "report.json", reportJson(report)); !written) return written;
  return writeText(path / "report.html", reportHtml(report));
}

}  // namespace eye
