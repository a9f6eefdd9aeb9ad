// How far predictions of the viewpoint are off: simulated manoeuvres and recorded tracks, several methods, horizons.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "link/track.h"

namespace eye {

// All at 300 m/s, 60 samples a second, with the attitude of coordinated flight.
enum class Manoeuvre {
  straight,           // level
  standardRateTurns,  // 3 degrees a second, half a minute to either side, straight stretches between
  bankReversals,      // from 60 degrees of bank to the other side and back, every 10 s
  climbs,             // pull-ups and push-overs of 1 g about level flight
};
const char* manoeuvreName(Manoeuvre manoeuvre);
inline constexpr Manoeuvre kManoeuvres[] = {Manoeuvre::straight, Manoeuvre::standardRateTurns, Manoeuvre::bankReversals,
                                            Manoeuvre::climbs};
std::vector<TrackSample> simulatedTrack(Manoeuvre manoeuvre, double durationS);

// The same flight with white noise on each axis of the positions.
std::vector<TrackSample> withNoise(std::vector<TrackSample> samples, double sigmaM, uint32_t seed);

struct PredictionRow {
  std::string manoeuvre, method;
  double horizonS = 0;
  double rmsM = 0, p95M = 0;  // in space
  // An axis; NaN for methods without a model, as is the share of places within the horizontal 98 % radius.
  double nisMean = 0, coverage98 = 0;
  double attitudeRmsDeg = 0;  // of the whole rotation
};

inline constexpr double kStudyHorizonsS[] = {0.1, 0.5, 1, 2, 5};

// `observed` is what the methods see, `truth` where the aircraft was at those times. Methods: hold, difference (the
// velocity of the last second), kalman6, kalman9, kalman12 with noises as configured, kalman9-adaptive.
std::vector<PredictionRow> studyPrediction(const std::string& name, const std::vector<TrackSample>& observed,
                                           const Track& truth);

}  // namespace eye
