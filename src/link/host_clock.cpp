#include "link/host_clock.h"

#include <algorithm>
#include <cstdlib>

namespace eye {
namespace {

constexpr int64_t kMs = 1'000'000, kSecond = 1000 * kMs;

constexpr int64_t kSpanNs = kSecond;
// Five seconds: clocks of computers drift by some 50 microseconds a second, so the offset is 0.25 ms old at most.
constexpr size_t kSpans = 5;
// Of a clock that is believed: 2 %, and what the least delay of one second differs from another's.
constexpr int64_t kMostDriftPercent = 2, kSpreadNs = 5 * kMs;
// The least delay does not shrink by so much, and no network that shows flights holds packets up for so long.
constexpr int64_t kSetForwardNs = 100 * kMs, kSetBackNs = 500 * kMs;
// A packet is overtaken when one that is up to so much newer came up to so long ago.
constexpr int64_t kMostOvertakenNs = 5 * kSecond, kMostHeldUpNs = kSecond;
// So many behind one another that are all behind the newest are a clock that was set back.
constexpr int kBegunAnew = 10;

}  // namespace

void HostClock::begin(int64_t stampNs, int64_t arrivedNs) {
  started_ = true;
  believed_ = false;
  behindRun_ = 0;
  newestNs_ = stampNs;
  newestArrivedNs_ = arrivedNs;
  spans_.assign(1, {arrivedNs, arrivedNs - stampNs});
}

bool HostClock::isOvertaken(int64_t aheadNs, int64_t arrivedNs) {
  if (aheadNs >= 0) {
    behindRun_ = 0;
    return false;
  }
  return -aheadNs <= kMostOvertakenNs && arrivedNs - newestArrivedNs_ <= kMostHeldUpNs && ++behindRun_ < kBegunAnew;
}

bool HostClock::isJump(int64_t offsetNs) const {
  return offsetNs < leastNs() - kSetForwardNs || offsetNs > leastNs() + kSetBackNs;
}

int64_t HostClock::leastNs() const {
  return std::ranges::min_element(spans_, {}, &Span::leastNs)->leastNs;
}

void HostClock::keep(int64_t offsetNs, int64_t arrivedNs) {
  if (arrivedNs - spans_.back().beganNs < kSpanNs) {
    spans_.back().leastNs = std::min(spans_.back().leastNs, offsetNs);
    return;
  }
  believed_ = spans_.size() > 1 && runsEvenly();
  spans_.push_back({arrivedNs, offsetNs});
  if (spans_.size() > kSpans + 1) spans_.erase(spans_.begin());
}

bool HostClock::runsEvenly() const {
  const Span &first = spans_.front(), &last = spans_.back();
  const int64_t driftNs = std::abs(last.leastNs - first.leastNs);
  return driftNs <= (last.beganNs - first.beganNs) / 100 * kMostDriftPercent + kSpreadNs;
}

Moment HostClock::take(int64_t stampNs, int64_t arrivedNs) {
  const auto byArrival = [&] {
    begin(stampNs, arrivedNs);
    newestAtNs_ = std::max(newestAtNs_, arrivedNs);
    return Moment{newestAtNs_, false, false};
  };
  if (!started_) return byArrival();

  int64_t aheadNs = (stampNs - newestNs_) % wrapNs_;
  if (aheadNs > wrapNs_ / 2) aheadNs -= wrapNs_;
  if (aheadNs < -wrapNs_ / 2) aheadNs += wrapNs_;
  const int64_t countedNs = newestNs_ + aheadNs, offsetNs = arrivedNs - countedNs;
  if (isOvertaken(aheadNs, arrivedNs))
    return {std::min(believed_ ? countedNs + leastNs() : arrivedNs, newestAtNs_), believed_, true};
  if (aheadNs < 0 || isJump(offsetNs)) return byArrival();

  newestNs_ = countedNs;
  newestArrivedNs_ = arrivedNs;
  keep(offsetNs, arrivedNs);
  newestAtNs_ = std::max(newestAtNs_, believed_ ? countedNs + leastNs() : arrivedNs);
  return {newestAtNs_, believed_, false};
}

}  // namespace eye
