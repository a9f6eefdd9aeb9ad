// The benchmark's suites: what each is given and what it hands back.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "bench/report.h"

namespace eye {

struct SuiteOptions {
  std::string terrain;  // a database; empty: the embedded demo
  std::string device;
  std::vector<std::string> tracks;     // recordings for the suite flight
  std::vector<std::string> elevation;  // sources of the database, the truth of the suite pareto; empty: its meshes
  std::vector<std::string> peaks;      // gazetteers for the suite panorama; empty: the terrain's own summits
  bool quick = false;                  // seconds instead of minutes: fewer views and frames
  std::function<void(const std::string& what, double share)> progress;  // 0 to 1 of the suite; may be empty
};

struct Suite {
  const char* name;
  const char* description;
  Result<SuiteReport> (*run)(const SuiteOptions& options);
};
std::span<const Suite> suites();  // in the order in which `all` runs them

Result<SuiteReport> runCullingSuite(const SuiteOptions& options);
Result<SuiteReport> runSelectorSuite(const SuiteOptions& options);
Result<SuiteReport> runFlightSuite(const SuiteOptions& options);
Result<SuiteReport> runGlobeSuite(const SuiteOptions& options);
Result<SuiteReport> runPanoramaSuite(const SuiteOptions& options);
Result<SuiteReport> runHostSuite(const SuiteOptions& options);
Result<SuiteReport> runParetoSuite(const SuiteOptions& options);
Result<SuiteReport> runFloorSuite(const SuiteOptions& options);
Result<SuiteReport> runStabilitySuite(const SuiteOptions& options);

}  // namespace eye
