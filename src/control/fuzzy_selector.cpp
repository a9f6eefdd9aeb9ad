#include "control/fuzzy_selector.h"

namespace eye {

Decision FuzzySelector::decide(const SelectorInput& input) {
  if (rules_.mode == SelectorMode::adaptive) return adaptive_.decide(input);
  const Decision decision = decideByPaper(rules_.paper, input, heldBand_);
  heldBand_ = decision.choice;
  return decision;
}

}  // namespace eye
