// The suite pareto's figures and what is made of them: rows, summary, tables, plots. Pure.
#pragma once

#include <string>
#include <vector>

#include "bench/pareto_runs.h"
#include "bench/report.h"

namespace eye {

// Whether none of the others of its size beats each result in time and in all of what is explained, the 99th percentile
// of the distances' errors and PSNR; times are relations to the default of the size.
std::vector<bool> paretoFront(const std::vector<ParetoResult>& results);

// `results`: each setting once, the default among them.
void addPareto(const std::vector<ParetoResult>& results, const std::string& truth, SuiteReport& report);

}  // namespace eye
