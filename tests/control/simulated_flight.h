// Flights over made-up ground on made-up machines, to judge a selector by time.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "control/fuzzy_selector.h"

namespace eye {

// What drawing costs. "Off" draws fixed + visible + occluded triangles; a size draws fewer and pays for its pass.
struct Machine {
  double fixedMs = 1.0;
  double visibleNs = 250, occludedNs = 120;
  std::array<double, kDepthMapSizes> passMs{};
  std::array<double, kDepthMapSizes> found{0.72, 0.82, 0.95, 1.0};  // of the hidden triangles
  double noise = 0.04;                                              // of a frame's cost, standard deviation
  size_t lateFrames = 0;  // how much older than the newest frame measurements are
};

// What the flight meets in a frame.
struct Place {
  double heightAboveGroundM = 0, reliefM = 0, pitchDeg = 0;
  double triangles = 0;
  double hiddenShare = 0;
  std::optional<double> occludedNs{};  // instead of the machine's
};
using Flight = std::function<Place(int frame)>;

struct FlightResult {
  double regret = 0;     // time over the best choice of every frame, in shares of the latter
  double overOff = 0;    // time over off, the same
  double worstOver = 0;  // greatest time over off in any 600 frames
  int changes = 0;       // of the choice, trials among them
  int switches = 0;      // of the choice that is held, trials left out
  std::vector<DepthMapChoice> choices;
};

// Costs are counted without noise; the selector is told them with noise of the seed, and with stalls.
// The first frame with a pass after one without saves nothing: what is hidden is known only after it.
FlightResult fly(const Flight& flight, const Machine& machine, int frames, const SelectorRules& rules = {},
                 unsigned seed = 1);

// Pyramid in compute shaders on lavapipe; last depth reduced by the CPU there; a graphics card.
Machine pyramidMachine();
Machine reuseMachine();
Machine cardMachine();

// Share of triangles hidden at a height over a relief, as measured over mountains, hills and plains.
double typicalHiddenShare(double heightAboveGroundM, double reliefM);

}  // namespace eye
