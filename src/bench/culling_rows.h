// The culling suite's figures and what is made of them: rows, summary, tables. Pure.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "bench/report.h"

namespace eye {

inline constexpr std::array<const char*, 3> kSchemes{"none", "frustum", "dynamic"};

// Of one view: medians of its frames; of a cell: means over its views.
struct SchemeFigures {
  double triangles = 0, vertices = 0, frameMs = 0, cpuMs = 0;
  double visibleTriangles = 0;
  std::map<std::string, double> passMs;     // wall time
  std::map<std::string, double> depthMaps;  // "800x600", "off": share of the views
};
void addView(const SchemeFigures& view, size_t views, SchemeFigures& mean);

struct CullingCell {
  std::string place;
  glm::ivec2 sizePx{};
  int altitudeFt = 0;  // above ground
  std::array<SchemeFigures, kSchemes.size()> schemes;
};

// Share of CPU time that dynamic saves against frustum over the cells that match; NaN where none does.
double savedCpu(const std::vector<CullingCell>& cells, const std::string& place, int belowFt);

SuiteReport cullingReport(const std::vector<CullingCell>& cells);

}  // namespace eye
