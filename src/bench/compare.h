// A run held against another: which figures are not what they were.
#pragma once

#include <string>
#include <vector>

#include "bench/figures.h"

namespace eye {

enum class Verdict { same, off, slower, faster, missing, added };

struct ComparedFigure {
  Figure figure;  // the baseline's; of `added`, the report's
  double now = 0;
  Verdict verdict = Verdict::same;
};

struct Comparison {
  std::vector<ComparedFigure> figures;  // in the baseline's order, then those that are new
  bool isSame() const;                  // nothing off, slower or missing; faster and new ones are no fault
};

// usage where the two were measured with other settings.
Result<Comparison> compare(const Figures& report, const Figures& baseline);

// What a person reads: every time, every figure that is not the same, and how many are.
std::string comparisonText(const Comparison& comparison);

// `eyepoint-bench compare`: prints the table; badData where something is not as it was. `update` writes the baseline.
Result<void> compareFiles(const std::string& reportPath, const std::string& baselinePath, bool update);

}  // namespace eye
