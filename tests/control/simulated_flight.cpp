#include "simulated_flight.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <random>

namespace eye {
namespace {

constexpr int kWindowFrames = 600;

double frameMs(const Machine& machine, const Place& place, DepthMapChoice choice, bool warm) {
  const double hidden = place.triangles * place.hiddenShare;
  const double occludedNs = place.occludedNs.value_or(machine.occludedNs);
  const double offMs = machine.fixedMs + ((place.triangles - hidden) * machine.visibleNs + hidden * occludedNs) * 1e-6;
  if (choice == DepthMapChoice::off) return offMs;
  const size_t size = sizeIndex(choice);
  const double savedMs = warm ? hidden * machine.found[size] * occludedNs * 1e-6 : 0;
  return offMs - savedMs + machine.passMs[size];
}

double bestMs(const Machine& machine, const Place& place) {
  double best = frameMs(machine, place, DepthMapChoice::off, true);
  for (const DepthMapChoice size : kDepthMaps) best = std::min(best, frameMs(machine, place, size, true));
  return best;
}

}  // namespace

FlightResult fly(const Flight& flight, const Machine& machine, int frames, const SelectorRules& rules, unsigned seed) {
  FuzzySelector selector(rules);
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, 1);
  FlightResult result;
  std::deque<SelectorInput> measurements;
  std::vector<double> overMs, offMs;
  double total = 0, best = 0, off = 0;
  DepthMapChoice last = DepthMapChoice::off, lastHeld = DepthMapChoice::off;
  for (int frame = 0; frame < frames; ++frame) {
    const Place place = flight(frame);
    SelectorInput input;
    if (measurements.size() > machine.lateFrames) {
      input = measurements.front();
      measurements.pop_front();
    }
    input.heightAboveGroundM = place.heightAboveGroundM;
    input.reliefM = place.reliefM;
    input.pitchDeg = place.pitchDeg;
    const Decision decision = selector.decide(input);
    const bool on = decision.choice != DepthMapChoice::off;
    const bool warm = last != DepthMapChoice::off;

    const double ms = frameMs(machine, place, decision.choice, warm);
    const double withoutMs = frameMs(machine, place, DepthMapChoice::off, true);
    total += ms;
    best += bestMs(machine, place);
    off += withoutMs;
    overMs.push_back(ms - withoutMs);
    offMs.push_back(withoutMs);
    result.choices.push_back(decision.choice);
    result.changes += decision.choice != last;
    if (!decision.trial) {
      result.switches += decision.choice != lastHeld;
      lastHeld = decision.choice;
    }
    last = decision.choice;

    const double passMs = on ? machine.passMs[sizeIndex(decision.choice)] * std::exp(0.1 * normal(random)) : 0;
    const double stall = random() % 100 == 0 ? 1.5 : 1.0;
    const double drawMs = ms - (on ? machine.passMs[sizeIndex(decision.choice)] : 0);
    input.used = decision.choice;
    input.passCostMs = passMs;
    input.frameCostMs = passMs + drawMs * std::exp(machine.noise * normal(random)) * stall;
    input.submittedTriangles = static_cast<uint64_t>(place.triangles);
    input.occludedTriangles =
        on && warm
            ? static_cast<uint64_t>(place.triangles * place.hiddenShare * machine.found[sizeIndex(decision.choice)])
            : 0;
    measurements.push_back(input);
  }
  double windowOver = 0, windowOff = 0;
  for (int frame = 0; frame < frames; ++frame) {
    const auto i = static_cast<size_t>(frame);
    windowOver += overMs[i];
    windowOff += offMs[i];
    if (frame >= kWindowFrames) {
      windowOver -= overMs[i - kWindowFrames];
      windowOff -= offMs[i - kWindowFrames];
    }
    if (frame >= kWindowFrames - 1) result.worstOver = std::max(result.worstOver, windowOver / windowOff);
  }
  result.regret = total / best - 1;
  result.overOff = total / off - 1;
  return result;
}

Machine pyramidMachine() {
  Machine machine;
  machine.passMs = {0.27, 0.40, 0.82, 1.25};
  return machine;
}

Machine reuseMachine() {
  Machine machine;
  machine.occludedNs = 95;
  machine.passMs = {0.10, 0.11, 0.15, 0.19};
  return machine;
}

Machine cardMachine() {
  Machine machine;
  machine.fixedMs = 0.3;
  machine.visibleNs = 4;
  machine.occludedNs = 2;
  machine.passMs = {0.02, 0.025, 0.04, 0.06};
  return machine;
}

double typicalHiddenShare(double heightAboveGroundM, double reliefM) {
  return 0.85 * std::exp(-2.4 * heightAboveGroundM / std::max(reliefM, 1.0));
}

}  // namespace eye
