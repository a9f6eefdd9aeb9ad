#include "control/pass_model.h"

#include <cmath>

namespace eye {
namespace {

constexpr int kSettleFrames = 1;          // to off or from one size to another: what is visible is known, or no matter
constexpr double kLongestFrameMs = 1000;  // a longer one was held up, and would stay in the means for many frames

bool usable(const SelectorInput& input) {
  return input.frameCostMs > 0 && input.frameCostMs <= kLongestFrameMs &&  // and no NaN
         input.passCostMs >= 0 && input.passCostMs <= input.frameCostMs &&
         input.occludedTriangles <= input.submittedTriangles;
}

}  // namespace

PassModel::PassModel(const AdaptiveRules& rules)
    : rules_(rules),
      share_(rules.shareOfLargest),
      passCostMs_(rules.passCostMs),
      triangleCost_(rules),
      budget_(rules) {}

void PassModel::learn(const SelectorInput& input, double sum) {
  const bool on = input.used != DepthMapChoice::off;
  const bool wasOn = used_ != DepthMapChoice::off;
  framesInUse_ = input.used == used_ ? framesInUse_ + 1 : 0;
  if (framesInUse_ == 0) {
    framesMeasured_ = 0;
    settleFrames_ = on && !wasOn ? rules_.settleFrames : std::min(rules_.settleFrames, kSettleFrames);
  }
  used_ = input.used;
  if (on && !wasOn) {
    drawOnMs_.restart();
    occluded_.restart();
    share_.restart();
    passCostMs_.restart();
  }
  if (!on && wasOn) drawOffMs_.restart();
  if (!usable(input)) return;

  const double passMs = on ? input.passCostMs : 0;
  const double occluded = on ? static_cast<double>(input.occludedTriangles) : 0;
  const double offMs = input.frameCostMs - passMs + occluded * triangleCost_.ms();
  provenGainMs_ = occluded * triangleCost_.provenMs() - passMs;
  budget_.account(offMs, provenGainMs_);
  offCostMs_.add(offMs);
  submitted_ = static_cast<double>(input.submittedTriangles);
  if (framesInUse_ < settleFrames_) return;

  framesMeasured_ = std::min(framesMeasured_ + 1, rules_.trialFrames);
  if (!on) {
    if (!isNear(sum, offSum_)) drawOffMs_.restart();
    offSum_ = sum;
    drawOffMs_.add(input.frameCostMs);
    if (submitted_ > 0) triangleCost_.bound(drawOffMs_.median() / submitted_);
    return;
  }
  if (shareMeasured_ && !isNear(sum, measuredSum_)) {
    drawOnMs_.restart();
    occluded_.restart();
  }
  drawOnMs_.add(input.frameCostMs - passMs);
  occluded_.add(occluded);
  passCostMs_.observe(used_, passMs);
  if (submitted_ == 0) return;
  share_.observe(used_, occluded / submitted_);
  shareMeasured_ = true;
  measuredSum_ = sum;
}

bool PassModel::compareWithOff() {
  if (!drawOffMs_.any() || !drawOnMs_.any() || !isNear(measuredSum_, offSum_)) return false;
  triangleCost_.observe(drawOffMs_.median() - drawOnMs_.median(), occluded_.mean());
  return true;
}

// Frames with such sums may be of one place; else the eye has jumped between them, as a host may have it do.
bool PassModel::isNear(double sum, double otherSum) const {
  return std::abs(sum - otherSum) <= rules_.measurementReach;
}

// Paper 001's eq. (2) with two rules: "still as measured" speaks for the measured share, its negation for the share
// that the sum stands for.
double PassModel::expectedShare(DepthMapChoice size, double sum) const {
  const double stillAsMeasured =
      shareMeasured_ ? std::max(0.0, 1.0 - std::abs(sum - measuredSum_) / rules_.measurementReach) : 0.0;
  const double bySum = membershipAt(rules_.shareOfSum, sum) * rules_.shareOfLargest[sizeIndex(size)];
  return std::clamp(stillAsMeasured * share_.at(size) + (1.0 - stillAsMeasured) * bySum, 0.0, 1.0);
}

double PassModel::gainMs(DepthMapChoice choice, double sum) const {
  if (choice == DepthMapChoice::off) return 0;
  return expectedShare(choice, sum) * submitted_ * triangleCost_.ms() - passCostMs_.at(choice);
}

DepthMapChoice PassModel::bestSize(double sum) const {
  DepthMapChoice best = kDepthMaps[0];
  for (const DepthMapChoice size : kDepthMaps) {
    if (gainMs(size, sum) > gainMs(best, sum)) best = size;
  }
  return best;
}

bool PassModel::affords(DepthMapChoice choice, int frames) const {
  return choice == DepthMapChoice::off || budget_.allows(passCostMs_.at(choice) * frames);
}

}  // namespace eye
