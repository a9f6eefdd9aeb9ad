// The figures of the suite stability: how far numbers stray at the edges of what may be asked. A limit holds where the
// figure is not above it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "app/options.h"

namespace eye {

struct StabilityFigure {
  std::string name;  // of the case
  double figure = 0, limit = 0;
  std::string unit;
  bool holds() const { return figure <= limit; }  // a figure that is no number does not
};

// Where vertices land: the vertex shader's arithmetic in floats against the same in double precision, over heights,
// latitudes, fields of view and near planes, each at `samples` random views. Pure; the same every time.
std::vector<StabilityFigure> vertexFigures(int samples);

// A day of clocks, and filters that never end. Pure; the same every time.
struct ClockEffort {
  int sunStepsPerS = 60;
  uint64_t filterSteps = 10'000'000;
};
std::vector<StabilityFigure> clockFigures(const ClockEffort& effort);

// Pictures: an eye that stands still, one that moves by millimetres, and states that no aircraft survives. Owner
// thread: render. `progress`: the case at hand.
struct FrameEffort {
  int stillFrames = 10'000, millimetres = 100, wildFrames = 600;
};
struct FrameFigures {
  std::vector<StabilityFigure> figures;
  std::string device;
};
Result<FrameFigures> frameFigures(const Options& options, const FrameEffort& effort,
                                  const std::function<void(const std::string& what)>& progress);

}  // namespace eye
