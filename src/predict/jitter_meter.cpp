#include "predict/jitter_meter.h"

#include <algorithm>
#include <cmath>

namespace eye {
namespace {

constexpr size_t kFewest = 16;
// Longer is a pause, not jitter.
constexpr double kPauseS = 1;
constexpr double kMostOfThem = 0.95;

}  // namespace

double JitterMeter::quantile(double q) {
  const auto at = sorted_.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(sorted_.size() - 1));
  std::ranges::nth_element(sorted_, at);
  return *at;
}

void JitterMeter::keep(Kind kind, double valueS) {
  if (kind != kind_) valuesS_.clear(), next_ = 0;
  kind_ = kind;
  if (valuesS_.size() < kKept) {
    valuesS_.push_back(valueS);
  } else {
    valuesS_[next_] = valueS;
    next_ = (next_ + 1) % kKept;
  }
  sorted_ = valuesS_;
}

void JitterMeter::arrived(double atS) {
  const double gapS = atS - lastS_;
  const bool first = lastS_ < 0;
  lastS_ = atS;
  if (first || gapS < 0 || gapS > kPauseS) return;
  keep(Kind::gaps, gapS);
  if (valuesS_.size() < kFewest) return;
  const double usualS = quantile(0.5);
  for (double& gap : sorted_) gap = std::abs(gap - usualS);
  jitterS_ = quantile(kMostOfThem);
}

void JitterMeter::heldUp(double byS) {
  keep(Kind::delays, byS);
  if (valuesS_.size() >= kFewest) jitterS_ = quantile(kMostOfThem);
}

}  // namespace eye
