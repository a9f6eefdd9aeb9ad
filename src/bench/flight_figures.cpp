#include "bench/flight_figures.h"

#include <algorithm>

namespace eye {

FlightFigures figuresOf(const FlightLog& log, double startS) {
  FlightFigures figures;
  std::vector<double> frameMs;
  for (const FlownFrame& frame : log.frames) {
    figures.slots += 1 + frame.missed;
    figures.missedFrames += frame.missed;
    figures.missingChunkFrames += frame.missing > 0 ? 1 : 0;
    frameMs.push_back(frame.frameMs);
    figures.cpuMs += frame.cpuMs;
    figures.intervalS += frame.intervalS;
    figures.aheadS += frame.aheadS;
    figures.coarsening += frame.coarsening;
    figures.keepsUpShare += frame.keepsUp ? 1 : 0;
    if (frame.timeS < startS) continue;
    ++figures.framesAfterStart;
    figures.slotsAfterStart += 1 + frame.missed;
    figures.missedAfterStart += frame.missed;
    figures.missingAfterStart += frame.missing > 0 ? 1 : 0;
    figures.mostMissing = std::max(figures.mostMissing, frame.missing);
  }
  figures.frames = log.frames.size();
  const auto count = std::max(static_cast<double>(log.frames.size()), 1.0);
  for (double* sum : {&figures.cpuMs, &figures.intervalS, &figures.aheadS, &figures.coarsening, &figures.keepsUpShare})
    *sum /= count;
  figures.frameMs = summarize(std::move(frameMs));
  figures.paging = log.paging;
  return figures;
}

std::string smoothness(size_t lost, size_t of) {
  constexpr double kSometimes = 0.005, kOften = 0.1;
  const double share = of > 0 ? static_cast<double>(lost) / static_cast<double>(of) : 0;
  return share < kSometimes ? "Smooth" : share < kOften ? "Relatively smooth" : "Frames drop out";
}

std::optional<WideningTrial> chooseWidening(std::span<const WideningTrial> trials, size_t missing) {
  std::optional<WideningTrial> chosen;
  for (const WideningTrial& trial : trials)
    if (trial.missing <= missing && (!chosen || trial.widening < chosen->widening)) chosen = trial;
  return chosen;
}

}  // namespace eye
