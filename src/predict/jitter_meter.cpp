#include "predict/jitter_meter.h"

#include <algorithm>
#include <cmath>

namespace eye {
namespace {

constexpr size_t kFewest = 16;
// Longer is a pause, not jitter.
constexpr double kPauseS = 1;

}  // namespace

void JitterMeter::observe(double arrivedS) {
  const double gapS = arrivedS - lastS_;
  const bool first = lastS_ < 0;
  lastS_ = arrivedS;
  if (first || gapS < 0 || gapS > kPauseS) return;
  if (gapsS_.size() < kKept) {
    gapsS_.push_back(gapS);
  } else {
    gapsS_[next_] = gapS;
    next_ = (next_ + 1) % kKept;
  }
  if (gapsS_.size() < kFewest) return;
  const auto quantile = [this](double q) {
    const auto at = sorted_.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(sorted_.size() - 1));
    std::ranges::nth_element(sorted_, at);
    return *at;
  };
  sorted_ = gapsS_;
  const double usualS = quantile(0.5);
  for (double& gap : sorted_) gap = std::abs(gap - usualS);
  jitterS_ = quantile(0.95);
}

}  // namespace eye
