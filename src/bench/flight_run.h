// A flight in real time: a frame at every slot of a clock that waits for nobody. Owner thread: render.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/steered_generator.h"
#include "link/track.h"

namespace eye {

// Of one frame.
struct FlownFrame {
  double timeS = 0;  // since take-off
  double frameMs = 0, cpuMs = 0;
  uint32_t missed = 0;     // slots behind it that passed before it was there
  uint32_t missing = 0;    // chunks drawn too coarse
  uint64_t bytesRead = 0;  // since the start
  double intervalS = 0, aheadS = 0;
  bool keepsUp = true;
  double coarsening = 1;
};

struct FlightLog {
  std::vector<FlownFrame> frames;
  double durationS = 0;               // of the flight; clocks end at the same place, frames or not
  PagingCounts paging;                // at its end, since the start
  std::optional<double> cachedShare;  // of the database's file, in the system's memory at take-off
};

// The slot of the next frame: the first that begins when the frame of `slot` is there, but not the same again.
uint64_t nextSlot(uint64_t slot, double elapsedS, double periodS);

// Flies the whole track. The clock of the generator goes on from `clockS`, which is moved to the end.
Result<FlightLog> fly(SteeredGenerator& generator, const Track& track, double rateHz, double& clockS);

struct FlightSetting {
  Options options;  // terrain, device, sse, predictor, widening, budgets
  double rateHz = 25;
};
// From a cold start: a new generator, the file's pages dropped.
Result<FlightLog> flyCold(const FlightSetting& setting, const Track& track);

}  // namespace eye
