#include "bench/regret.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace eye {

FrameTimes runningMedian(const FrameTimes& times, size_t reach) {
  FrameTimes medians(times.size());
  FrameTimes window;
  for (size_t i = 0; i < times.size(); ++i) {
    const size_t first = i > reach ? i - reach : 0, end = std::min(i + reach + 1, times.size());
    window.assign(times.begin() + static_cast<std::ptrdiff_t>(first), times.begin() + static_cast<std::ptrdiff_t>(end));
    std::ranges::sort(window);
    const size_t half = window.size() / 2;
    medians[i] = window.size() % 2 == 1 ? window[half] : (window[half - 1] + window[half]) / 2;
  }
  return medians;
}

std::vector<size_t> bestChoices(std::span<const FrameTimes> fixed, size_t reach) {
  std::vector<size_t> best;
  if (fixed.empty()) return best;
  std::vector<FrameTimes> medians;
  for (const FrameTimes& times : fixed) medians.push_back(runningMedian(times, reach));
  best.assign(medians[0].size(), 0);
  for (size_t i = 0; i < best.size(); ++i)
    for (size_t choice = 1; choice < medians.size(); ++choice)
      if (medians[choice][i] < medians[best[i]][i]) best[i] = choice;
  return best;
}

double regret(const FrameTimes& mode, std::span<const FrameTimes> fixed, std::span<const size_t> best) {
  double bestMs = 0;
  for (size_t i = 0; i < best.size(); ++i) bestMs += fixed[best[i]][i];
  return std::accumulate(mode.begin(), mode.end(), 0.0) / bestMs - 1;
}

double worstLoss(const FrameTimes& mode, const FrameTimes& other, size_t frames) {
  frames = std::min(frames, mode.size());
  double modeMs = 0, otherMs = 0, worst = -std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < mode.size(); ++i) {
    modeMs += mode[i];
    otherMs += other[i];
    if (i >= frames) {
      modeMs -= mode[i - frames];
      otherMs -= other[i - frames];
    }
    if (i + 1 >= frames) worst = std::max(worst, modeMs / otherMs - 1);
  }
  return worst;
}

}  // namespace eye
