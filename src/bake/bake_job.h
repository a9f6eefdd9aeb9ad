// A whole bake from sources to a database, as eyepoint-bake runs it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bake/baker.h"

namespace eye {

struct BakeJob {
  std::vector<std::string> elevation, imagery;  // in order of preference
  std::string out;
  std::string verticalDatum;  // empty: heights as they are
  PlanOptions plan;
  bool resume = false;
};

// Logs what it finds in the sources. `control.sourceError` is filled in here.
Result<BakeOutcome> runBake(const BakeJob& job, BakeControl control);

}  // namespace eye
