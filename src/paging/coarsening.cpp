#include "paging/coarsening.h"

#include <algorithm>

namespace eye {
namespace {

// A frame's change: three times coarser in a second of starving, and back from that in about as long.
constexpr double kCoarser = 1.02, kFiner = 0.982;
constexpr double kCoarsest = 64;
// Of the resident groups, the share that must be free to go before more is asked for: a step finer wants a few per
// cent.
constexpr double kSpareShare = 0.15;

}  // namespace

void Coarsening::steer(bool isStarved, Residency& residency) {
  if (isStarved) {
    factor_ = std::min(factor_ * kCoarser, kCoarsest);
  } else if (factor_ > 1 && residency.evictableShare() > kSpareShare) {
    factor_ = std::max(factor_ * kFiner, 1.0);
  }
}

}  // namespace eye
