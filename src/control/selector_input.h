// What the selector is told once a frame, and what it answers.
#pragma once

#include <cstdint>

#include "control/depth_map_choice.h"

namespace eye {

// Any number may be NaN or infinite: an unusable pose gives `off`, an unusable measurement is not learnt from.
struct SelectorInput {
  // The eye of the frame that is about to be drawn.
  double heightAboveGroundM = 0;
  double reliefM = 0;       // highest minus lowest terrain of the visible surroundings
  double altitudeMslM = 0;  // read by the paper's mode alone, and only where the rules say so
  double pitchDeg = 0;      // nose up

  // The newest measured frame; frameCostMs 0: none yet.
  DepthMapChoice used = DepthMapChoice::off;
  uint64_t submittedTriangles = 0;  // left by the other tests: what `off` would draw
  uint64_t occludedTriangles = 0;   // those of them that the pass kept from being drawn
  double passCostMs = 0;            // depth map, pyramid, test; 0 where `used` is off
  double frameCostMs = 0;           // culling and drawing, with the pass; same unit and clock as passCostMs
};

struct Decision {
  DepthMapChoice choice = DepthMapChoice::off;
  double altitudeMembership = 0, pitchMembership = 0;
  double sum = 0;             // weighted; 0 to 2 with the built-in rules
  double expectedGainMs = 0;  // of `choice` against off; adaptive mode
  bool trial = false;         // tried for a few frames to measure it; adaptive mode
};

}  // namespace eye
