// The selector suite's flight: five minutes round the plain's spot and five round the mountains', each from 30 m to
// 10,000 m above the ground and back, with turns and pitches. Pure but for the ground's heights.
#pragma once

#include "bench/ground_heights.h"
#include "bench/places.h"
#include "link/track.h"

namespace eye {

inline constexpr double kFlightHalfS = 300;  // round one place
inline constexpr double kFlightS = 2 * kFlightHalfS;

// Metres above the ground, by the time since the half began.
double flightHeightM(double halfS);

struct SelectorFlight {
  std::array<Track, 2> halves;  // plain, mountains
  // `timeS`: 0 to kFlightS.
  Pose at(double timeS) const;
};
Result<SelectorFlight> makeSelectorFlight(const std::array<Place, 2>& places, GroundHeights& ground);

}  // namespace eye
