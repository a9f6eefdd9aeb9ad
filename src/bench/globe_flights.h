// Flights where a globe's grid is at its worst: over both poles and along the date line, in real time.
#pragma once

#include <array>
#include <string>

#include "app/statistics.h"
#include "bench/steered_generator.h"

namespace eye {

struct GlobeFlight {
  const char* name;
  Pose (*poseAt)(double alongM);  // 0 half way, over the pole
};
extern const std::array<GlobeFlight, 3> kGlobeFlights;

struct GlobeFlightFigures {
  size_t frames = 0, missingAfterStart = 0;  // frames with a chunk drawn too coarse after `startS`
  TimeSummary frameMs;
  size_t framesLookedAt = 0, holes = 0;  // pixels without terrain below the horizon
};

// 25 slots a second, 8 km/s; every tenth frame in which nothing is missing is searched for holes. The ground lies above
// -`depthM`.
Result<GlobeFlightFigures> flyOverGlobe(SteeredGenerator& generator, const GlobeFlight& flight, double durationS,
                                        double startS, double depthM);

}  // namespace eye
