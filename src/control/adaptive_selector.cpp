#include "control/adaptive_selector.h"

#include <cmath>

namespace eye {
namespace {

constexpr double kLeastReliefM = 1;      // ground flatter than this hides nothing from any height
constexpr int kTrialPatienceFrames = 8;  // beyond a trial's own frames, for measurements that come late or not at all

constexpr int kOffsTurn = 0, kSmallersTurn = 1, kLargersTurn = 2;

}  // namespace

AdaptiveSelector::AdaptiveSelector(const AdaptiveRules& rules)
    : rules_(rules),
      model_(rules),
      framesSinceTrial_(rules.firstIntervalFrames),
      intervalFrames_(rules.firstIntervalFrames) {}

Decision AdaptiveSelector::decide(const SelectorInput& input) {
  model_.learn(input, decidedSum_);
  Decision decision;
  const double heightOverRelief = std::max(input.heightAboveGroundM, 0.0) / std::max(input.reliefM, kLeastReliefM);
  if (!std::isfinite(input.heightAboveGroundM) || !std::isfinite(input.reliefM) || !std::isfinite(input.pitchDeg))
    return decision;
  decision.altitudeMembership = membershipAt(rules_.heightOverRelief, heightOverRelief);
  decision.pitchMembership = membershipAt(rules_.pitchDeg, input.pitchDeg);
  decision.sum = rules_.altitudeWeight * decision.altitudeMembership + rules_.pitchWeight * decision.pitchMembership;
  decidedSum_ = decision.sum;
  decision.choice = choose(decision.sum);
  decision.trial = trial_.has_value();
  decision.expectedGainMs = model_.gainMs(decision.choice, decision.sum);
  return decision;
}

DepthMapChoice AdaptiveSelector::choose(double sum) {
  framesHeld_ = std::min(framesHeld_ + 1, rules_.dwellFrames);
  framesSinceTrial_ = std::min(framesSinceTrial_ + 1, rules_.longestIntervalFrames);
  if (!trial_) {
    reconsider(sum);
  } else {
    ++trial_->frames;
    const bool measured = model_.used() == trial_->choice && model_.framesMeasured() >= rules_.trialFrames;
    if (!measured && trial_->frames < ownFrames() + kTrialPatienceFrames) return trial_->choice;
    concludeTrial(measured, sum);
  }
  if (const std::optional<DepthMapChoice> choice = dueTrial(sum)) trial_ = Trial{*choice, 0};
  return trial_ ? trial_->choice : held_;
}

void AdaptiveSelector::concludeTrial(bool measured, double sum) {
  const bool againstOff = held_ == DepthMapChoice::off || trial_->choice == DepthMapChoice::off;
  const DepthMapChoice before = held_;
  const bool isOfTwoPlaces = measured && againstOff && !model_.compareWithOff();
  if (measured && held_ == DepthMapChoice::off) {
    const DepthMapChoice best = model_.bestSize(sum);
    if (model_.gainMs(best, sum) > rules_.hysteresis * model_.offMs()) hold(best);
  } else {
    reconsider(sum);
  }
  trial_.reset();
  framesSinceTrial_ = 0;
  if (isOfTwoPlaces) {
    // A size that is held all the same is compared with off here at once.
    if (held_ != before) framesSinceTrial_ = intervalFrames_;
    return;
  }
  triedSum_ = sum;
  if (held_ == before) intervalFrames_ = std::min(2 * intervalFrames_, rules_.longestIntervalFrames);
}

// Whether the held size still gains most. Off is left by trials alone.
void AdaptiveSelector::reconsider(double sum) {
  if (held_ == DepthMapChoice::off) return;
  if (model_.overspent()) {
    hold(DepthMapChoice::off);
    return;
  }
  if (framesHeld_ < rules_.dwellFrames) return;
  const DepthMapChoice best = model_.bestSize(sum);
  const DepthMapChoice better = model_.gainMs(best, sum) > 0 ? best : DepthMapChoice::off;
  if (model_.gainMs(better, sum) - model_.gainMs(held_, sum) > rules_.hysteresis * model_.offMs()) hold(better);
}

void AdaptiveSelector::hold(DepthMapChoice choice) {
  held_ = choice;
  framesHeld_ = 0;
  framesSinceTrial_ = 0;
  intervalFrames_ = rules_.firstIntervalFrames;
  turn_ = kOffsTurn;
}

std::optional<DepthMapChoice> AdaptiveSelector::dueTrial(double sum) {
  if (held_ != DepthMapChoice::off) {
    if (framesSinceTrial_ < intervalFrames_) return std::nullopt;
    return nextAlternative();
  }
  const DepthMapChoice best = model_.bestSize(sum);
  const bool promising = model_.gainMs(best, sum) > rules_.hysteresis * model_.offMs();
  // What a trial has found in another place may say nothing of this one.
  const bool isElsewhere = std::abs(sum - triedSum_) > rules_.measurementReach;
  if (framesSinceTrial_ < (promising || isElsewhere ? rules_.firstIntervalFrames : intervalFrames_))
    return std::nullopt;
  if (!model_.affords(best, ownFrames())) return std::nullopt;
  return best;
}

// Off, the size below, the size above, in turn, as far as there are such. Off first: it is what tells most about
// whether a new size pays.
DepthMapChoice AdaptiveSelector::nextAlternative() {
  const size_t index = sizeIndex(held_);
  if (turn_ == kSmallersTurn && index == 0) turn_ = kLargersTurn;
  if (turn_ == kLargersTurn && index + 1 == kDepthMapSizes) turn_ = kOffsTurn;
  const int turn = turn_;
  turn_ = (turn_ + 1) % 3;
  if (turn == kSmallersTurn) return kDepthMaps[index - 1];
  if (turn == kLargersTurn) return kDepthMaps[index + 1];
  return DepthMapChoice::off;
}

}  // namespace eye
