#include "control/paper_selector.h"

#include <cmath>

namespace eye {
namespace {

constexpr double kFtPerM = 1 / 0.3048;  // the international foot

}  // namespace

DepthMapChoice bandOf(const std::array<double, kDepthMapSizes>& bands, double sum) {
  DepthMapChoice choice = DepthMapChoice::off;
  for (const DepthMapChoice size : kDepthMaps) {
    if (sum >= bands[sizeIndex(size)]) choice = size;
  }
  return choice;
}

DepthMapChoice bandWithHysteresis(const PaperRules& rules, double sum, DepthMapChoice held) {
  const DepthMapChoice rising = bandOf(rules.bands, sum);
  const DepthMapChoice falling = bandOf(rules.bands, sum + rules.hysteresis);
  if (rising > held) return rising;
  return falling < held ? falling : held;
}

Decision decideByPaper(const PaperRules& rules, const SelectorInput& input, std::optional<DepthMapChoice> held) {
  const double altitudeM =
      rules.altitudeReference == AltitudeReference::ground ? input.heightAboveGroundM : input.altitudeMslM;
  Decision decision;
  if (!std::isfinite(altitudeM) || !std::isfinite(input.pitchDeg)) return decision;
  decision.altitudeMembership = membershipAt(rules.altitudeFt, altitudeM * kFtPerM);
  decision.pitchMembership = membershipAt(rules.pitchDeg, input.pitchDeg);
  decision.sum = decision.altitudeMembership + decision.pitchMembership;
  decision.choice = held ? bandWithHysteresis(rules, decision.sum, *held) : bandOf(rules.bands, decision.sum);
  return decision;
}

}  // namespace eye
