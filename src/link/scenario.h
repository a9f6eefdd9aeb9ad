// Built-in flights, the same in eyepoint (demo://) and eyepoint-host (--scenario): pure functions of time.
#pragma once

#include <string>
#include <vector>

#include "base/error.h"
#include "geo/pose.h"

namespace eye {

struct Scenario {
  std::string name, description;
  double durationS = 0;
  Pose (*poseAt)(double timeS) = nullptr;  // clamped to [0, durationS]
};

inline constexpr const char* kDefaultScenario = "tour";  // of demo:// without a name

// takeoff, low-level, orbit, approach, descent-from-space, tour: over the embedded demo terrain (36.63 N 128.35 E).
const std::vector<Scenario>& scenarios();
Result<Scenario> findScenario(const std::string& name);  // usage error that lists the names

}  // namespace eye
