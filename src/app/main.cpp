// eyepoint: the image generator. Arguments only; a run is app/run.cpp, a frame app/image_generator.cpp.
#include <cstdio>

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "app/options.h"
#include "app/process_setup.h"
#include "app/run.h"
#include "telemetry/trace.h"

int main(int argc, char** argv) {
  const int64_t startedNs = eye::monotonicNs();
  eye::setUpProcess();

  const eye::ParsedOptions parsed = eye::parseOptions(argc, argv);
  if (parsed.exitStatus) {
    if (*parsed.exitStatus == 0)
      std::fputs(parsed.text.c_str(), stdout);
    else
      std::fprintf(stderr, "eyepoint: %s\n", parsed.text.c_str());
    return *parsed.exitStatus;
  }
  const auto log = spdlog::stderr_color_mt("eyepoint");
  log->set_pattern("[%H:%M:%S.%e] %^%l%$ %v");
  spdlog::set_default_logger(log);
  spdlog::set_level(spdlog::level::from_str(parsed.options.logLevel));

  const eye::Result<void> result =
      parsed.options.listDevices ? eye::printDevices() : eye::run(parsed.options, startedNs);
  if (result) return 0;
  std::fprintf(stderr, "eyepoint: %s\n", result.error().message.c_str());
  return eye::exitStatus(result.error());
}
