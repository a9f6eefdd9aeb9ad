#include "bench/flight_run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "bench/page_cache.h"
#include "telemetry/trace.h"

namespace eye {
namespace {

FlownFrame flownFrame(const FrameRecord& record, double timeS, uint64_t bytesBefore) {
  return {.timeS = timeS,
          .frameMs = record.frameMs,
          .cpuMs = record.cpuMs,
          .missing = record.selection.missing,
          .bytesRead = record.paging.bytesRead - bytesBefore,
          .intervalS = record.pace.interval.lengthS,
          .aheadS = record.pace.memoryS,
          .keepsUp = record.pace.interval.keepsUp,
          .coarsening = record.coarsening};
}

}  // namespace

uint64_t nextSlot(uint64_t slot, double elapsedS, double periodS) {
  // A slot that has just begun is still in time.
  constexpr double kLateShare = 0.02;
  const double begun = std::ceil(elapsedS / periodS - kLateShare);
  return std::max(slot + 1, static_cast<uint64_t>(std::max(begun, 0.0)));
}

Result<FlightLog> fly(SteeredGenerator& generator, const Track& track, double rateHz, double& clockS) {
  FlightLog log;
  log.durationS = track.durationS();
  const double periodS = 1 / rateHz;
  const auto slots = static_cast<uint64_t>(std::floor(track.durationS() * rateHz));
  std::optional<uint64_t> bytesBefore;
  const int64_t beganNs = monotonicNs();
  const auto elapsedS = [&] { return static_cast<double>(monotonicNs() - beganNs) * 1e-9; };
  for (uint64_t slot = 0; slot <= slots;) {
    const double timeS = static_cast<double>(slot) * periodS;
    const Result<FrameRecord> record = generator.frame(track.at(timeS), clockS + timeS);
    if (!record) return tl::unexpected(record.error());
    if (!bytesBefore) bytesBefore = clockS == 0 ? 0 : record->paging.bytesRead;
    log.frames.push_back(flownFrame(*record, timeS, *bytesBefore));
    log.paging = record->paging;
    const uint64_t next = nextSlot(slot, elapsedS(), periodS);
    log.frames.back().missed = static_cast<uint32_t>(std::min(next, slots + 1) - slot - 1);
    slot = next;
    const double waitS = static_cast<double>(slot) * periodS - elapsedS();
    if (waitS > 0) std::this_thread::sleep_for(std::chrono::duration<double>(waitS));
  }
  clockS += track.durationS() + periodS;
  return log;
}

Result<FlightLog> flyCold(const FlightSetting& setting, const Track& track) {
  const std::string path = setting.options.terrain.empty() ? defaultTerrainPath() : setting.options.terrain;
  const std::optional<double> cachedShare = dropFromPageCache(path);
  Result<SteeredGenerator> generator = SteeredGenerator::create(setting.options, false);
  if (!generator) return tl::unexpected(generator.error());
  double clockS = 0;
  Result<FlightLog> log = fly(*generator, track, setting.rateHz, clockS);
  if (log) log->cachedShare = cachedShare;
  return log;
}

}  // namespace eye
