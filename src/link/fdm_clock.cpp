#include "link/fdm_clock.h"

#include <cmath>

namespace eye {
namespace {

constexpr int64_t kMeasuredNs = 4'000'000'000;
constexpr double kTolerance = 0.03;                // jitter of 60 ms at either end of four seconds
constexpr int kFewestDigits = 3, kMostDigits = 9;  // of the ticks in a second
constexpr double kSecondNs = 1e9, kTicksPerWrap = 4294967296.0;

// The power of ten that the rate is, if it is one.
std::optional<double> ticksPerSecond(double measured) {
  for (int digits = kFewestDigits; digits <= kMostDigits; ++digits) {
    const double ticks = std::pow(10.0, digits);
    if (std::abs(measured / ticks - 1) < kTolerance) return ticks;
  }
  return std::nullopt;
}

}  // namespace

void FdmClock::measure(uint32_t ticks, int64_t arrivedNs) {
  // Modulo 2^32: overtaken packets count back, and the sum stays right.
  counted_ = measuring_ ? counted_ + static_cast<int32_t>(ticks - newest_) : 0;
  if (!measuring_) beganNs_ = arrivedNs;
  measuring_ = true;
  newest_ = ticks;
  const int64_t sinceNs = arrivedNs - beganNs_;
  if (sinceNs < kMeasuredNs) return;
  const auto rate = ticksPerSecond(static_cast<double>(counted_) * kSecondNs / static_cast<double>(sinceNs));
  measuring_ = false;
  if (!rate) return;
  tickNs_ = kSecondNs / *rate;
  clock_.emplace(std::llround(kTicksPerWrap * tickNs_));
}

Moment FdmClock::take(uint32_t ticks, int64_t arrivedNs) {
  if (!clock_) {
    measure(ticks, arrivedNs);
    return {arrivedNs, false, false};
  }
  Moment moment = clock_->take(std::llround(static_cast<double>(ticks) * tickNs_), arrivedNs);
  // Whether one packet is older than another is not asked of a clock that may be none.
  if (!moment.byHost) moment.overtaken = false;
  return moment;
}

}  // namespace eye
