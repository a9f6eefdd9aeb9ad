#include "paging/coarsening.h"

#include <algorithm>
#include <cmath>

namespace eye {
namespace {

// Changes are per second: three times coarser in a second of starving, and back from that in about as long.
constexpr double kCoarser = 3.3, kFiner = 1 / kCoarser;
// A step finer loads a level at once: larger ones after a long frame would overshoot what fits.
constexpr double kLongestStepS = 0.1;
constexpr double kCoarsest = 64;
// Of the resident groups, the share that must be free to go before more is asked for: a step finer wants a few per
// cent.
constexpr double kSpareShare = 0.15;
// With so many free the view has changed, and what was too fine before says nothing any more.
constexpr double kPlentyShare = 0.4, kMuchFiner = 0.0018;
// What was too fine is not tried again at once, lest a level be loaded and evicted in turns; in flight after some time.
constexpr double kAboveStarved = 1.05, kForgetting = 0.94;

}  // namespace

void Coarsening::steer(double stepS, bool isStarved, bool isMoving, const Residency& residency) {
  stepS = std::min(stepS, kLongestStepS);
  const auto inStep = [stepS](double perSecond) { return std::pow(perSecond, stepS); };
  if (isStarved) {
    starvedAt_ = factor_;
    factor_ = std::min(factor_ * inStep(kCoarser), kCoarsest);
    return;
  }
  if (factor_ <= 1) return;
  const double spare = residency.spareShare();
  if (spare > kPlentyShare) {
    starvedAt_ = 1;
  } else if (isMoving) {
    starvedAt_ *= inStep(kForgetting);
  }
  const double finest = starvedAt_ > 1 ? starvedAt_ * kAboveStarved : 1;
  const double next = factor_ * inStep(spare > kPlentyShare ? kMuchFiner : kFiner);
  if (spare > kSpareShare && (next >= finest || finest <= 1)) factor_ = std::max(next, 1.0);
}

}  // namespace eye
