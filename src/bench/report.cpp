#include "bench/report.h"

#include <unistd.h>

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
