#include "control/loss_budget.h"

#include <algorithm>

namespace eye {

void LossBudget::account(double offMs, double gainMs) {
  constexpr double kMemoryFrames = 60;  // of the mean frame cost that the reserve is counted in
  const double fullMs = offMs * rules_.lossReserve;
  fullMs_ = started_ ? fullMs_ + (fullMs - fullMs_) / kMemoryFrames : fullMs;
  started_ = true;
  reserveMs_ = std::min(reserveMs_ + offMs * rules_.lossRate + gainMs, fullMs_);
}

bool LossBudget::allows(double lossMs) const {
  return started_ && reserveMs_ >= std::min(lossMs, 0.999 * fullMs_);
}

}  // namespace eye
