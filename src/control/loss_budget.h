// What occlusion culling may lose against drawing everything: a reserve that fills with every frame.
#pragma once

#include "control/selector_rules.h"

namespace eye {

// Over any n frames the losses it lets pass are at most lossRate * n + lossReserve frames' cost, and the one loss that
// emptied it: 1.2 % of 600 frames with the built-in rules.
// It starts empty: the first frame may be far from what frames cost.
class LossBudget {
 public:
  explicit LossBudget(const AdaptiveRules& rules) : rules_(rules) {}

  // A frame that would have cost `offMs` without the pass, and gained (or lost, negative) so much by it.
  void account(double offMs, double gainMs);
  bool empty() const { return reserveMs_ < 0; }
  // Whether so much may be lost; more than the whole reserve may when it is full.
  bool allows(double lossMs) const;

 private:
  AdaptiveRules rules_;
  double reserveMs_ = 0, fullMs_ = 0;
  bool started_ = false;
};

}  // namespace eye
