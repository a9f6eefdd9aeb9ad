// Paper 001's selector: altitude and pitch alone.
#pragma once

#include <optional>

#include "control/selector_input.h"
#include "control/selector_rules.h"

namespace eye {

// The size whose band holds the sum: half-open, the lower edge included; below the first edge off (Table 2).
DepthMapChoice bandOf(const std::array<double, kDepthMapSizes>& bands, double sum);

// The same, but the held size stays until the sum is below its band by the hysteresis. Rises are at the paper's edges,
// so that level flight, whose sum lies on one (1.5 below 4,000 ft), has the paper's size.
DepthMapChoice bandWithHysteresis(const PaperRules& rules, double sum, DepthMapChoice held);

// Table 1's memberships and their sum, and the choice. Nothing held: the band itself. An altitude or pitch that is no
// number, or infinite: off, with memberships 0.
Decision decideByPaper(const PaperRules& rules, const SelectorInput& input, std::optional<DepthMapChoice> held);

}  // namespace eye
