// eyepoint: the image generator. Arguments only; a run is app/run.cpp, a frame app/image_generator.cpp.
#include <cstdio>

#include "app/options.h"
#include "app/process_setup.h"
#include "app/run.h"
#include "base/command_line.h"
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
  eye::logToStderr("eyepoint", parsed.options.logLevel);

  const eye::Result<void> result =
      parsed.options.listDevices ? eye::printDevices() : eye::run(parsed.options, startedNs);
  return result ? 0 : eye::complain("eyepoint", result.error());
}
