#include "base/command_line.h"

#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

namespace eye {

int complain(const std::string& program, const Error& error) {
  fmt::print(stderr, "{}: {}\n", program, error.message);
  return exitStatus(error);
}

std::optional<int> parseArguments(CLI::App& app, int argc, const char* const* argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {
    return app.exit(asked);
  } catch (const CLI::ParseError& problem) {
    return complain(app.get_name(), {ErrorKind::usage, fmt::format("{} (see --help)", problem.what())});
  }
  return std::nullopt;
}

void logToStderr(const std::string& program, const std::string& level) {
  const auto log = spdlog::stderr_color_mt(program);
  log->set_pattern("[%H:%M:%S.%e] %^%l%$ %v");
  spdlog::set_default_logger(log);
  spdlog::set_level(spdlog::level::from_str(level));
}

}  // namespace eye
