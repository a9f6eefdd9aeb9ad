// What a flight amounts to. Pure.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "app/statistics.h"
#include "bench/flight_run.h"

namespace eye {

struct FlightFigures {
  size_t slots = 0, frames = 0;
  size_t missedFrames = 0, missingChunkFrames = 0;
  // The same, without the start.
  size_t slotsAfterStart = 0, framesAfterStart = 0, missedAfterStart = 0, missingAfterStart = 0;
  uint32_t mostMissing = 0;                                            // chunks in a frame after the start
  TimeSummary frameMs;                                                 // all frames
  double cpuMs = 0;                                                    // mean of a frame
  double intervalS = 0, aheadS = 0, coarsening = 0, keepsUpShare = 0;  // means
  PagingCounts paging;
};
FlightFigures figuresOf(const FlightLog& log, double startS);

// The paper's words: no frame drops out (fewer than one in two hundred), some do (fewer than one in ten), or they do.
std::string smoothness(size_t lost, size_t of);

// A flight without prediction whose region was widened.
struct WideningTrial {
  double widening = 1;
  size_t missing = 0;  // frames with chunks missing after the start
  uint64_t bytesRead = 0;
};
// The least widened trial that misses no more frames than `missing`.
std::optional<WideningTrial> chooseWidening(std::span<const WideningTrial> trials, size_t missing);

}  // namespace eye
