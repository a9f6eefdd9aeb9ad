// The figures of a report that another run can be held against: what is counted must be the same, what takes CPU time
// is compared after both machines' speed is divided out.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/error.h"

namespace eye {

enum class FigureKind {
  count,   // the same wherever it is counted
  pixels,  // hangs on what a device draws: nearly the same
  time,    // CPU time, in units of the speed reference that was measured beside it
};

struct Figure {
  std::string name;  // "culling: mountains, 2000 ft, frustum: triangles"
  FigureKind kind = FigureKind::count;
  double value = 0;
  double band = 0;  // as a share of the baseline: how far off still counts as the same; of times: how much slower
};

// Of one report, or of a baseline that was made from one.
struct Figures {
  std::string machine, device, settings;
  std::vector<Figure> figures;
};

// `json`: a report.json or a baseline. badData says which key is missing or of the wrong kind; `name`: of the file.
Result<Figures> figuresOf(const nlohmann::ordered_json& json, const std::string& name);
// Reads and parses the file first.
Result<Figures> readFigures(const std::string& path);
// As a baseline, one figure a line.
std::string baselineJson(const Figures& figures);

}  // namespace eye
