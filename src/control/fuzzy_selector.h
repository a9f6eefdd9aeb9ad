// The selector: each frame, frustum culling alone or occlusion culling with which depth map (paper 001).
#pragma once

#include <optional>

#include "control/adaptive_selector.h"
#include "control/paper_selector.h"

namespace eye {

// Deterministic: no clock, no randomness; the same inputs in the same order give the same decisions.
// Owner thread: render. Call decide() once a frame.
class FuzzySelector {
 public:
  explicit FuzzySelector(const SelectorRules& rules = {}) : rules_(rules), adaptive_(rules.adaptive) {}
  Decision decide(const SelectorInput& input);

 private:
  SelectorRules rules_;
  AdaptiveSelector adaptive_;
  std::optional<DepthMapChoice> heldBand_;  // the paper's mode
};

}  // namespace eye
