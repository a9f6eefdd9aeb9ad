// The culling suite's figures and what is made of them: rows, summary, tables. Pure.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "bench/report.h"

namespace eye {

// The first three are the paper's and ours by default. The last is dynamic culling without the selector: what the pass
// itself saves or costs, for telling that from the selector's choice.
inline constexpr std::array<const char*, 4> kSchemes{"none", "frustum", "dynamic", "dynamic_320x240"};
inline constexpr size_t kPaperSchemes = 3;

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

// Share of CPU time that a scheme saves against frustum over the cells that match; NaN where none does.
double savedCpu(const std::vector<CullingCell>& cells, const std::string& scheme, const std::string& place,
                int belowFt);

// The greatest difference of CPU time between dynamic and frustum where every view of dynamic was without a depth map:
// both did the same work, so this is what the measurement itself is worth. NaN where there is no such cell.
double measurementNoise(const std::vector<CullingCell>& cells);

SuiteReport cullingReport(const std::vector<CullingCell>& cells);

}  // namespace eye
