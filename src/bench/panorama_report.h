// The panorama suite's figures and what is made of them: rows, summary, tables, plots. Pure.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "bench/panorama_figures.h"
#include "bench/report.h"

namespace eye {

// The ways to tell a distance that are compared; see docs/PANORAMA.md.
enum PanoramaMethod : size_t {
  methodRange,          // ours
  methodPaper,          // --depth paper: planar, 24 bits, near plane at 1 m
  methodPlanar,         // what the planar depth alone would do, computed
  methodNearPlane,      // with 24 bits and the near plane at 10 cm, computed
  methodSquareDegrees,  // as methodPaper on terrain whose degrees are as wide as they are high, computed
  methodCount
};

struct MeasuredPeak {
  std::string name, viewpoint;
  bool isAboveEye = false;
  double trueM = 0;    // to the gazetteer's place and height
  double groundM = 0;  // to the terrain's own summit
  std::array<double, methodCount> toldM{};
};

// Peaks that were in sight and that a picture has nothing of: told as 0 m.
SuiteReport panoramaReport(std::span<const MeasuredPeak> peaks, size_t viewpoints);

}  // namespace eye
