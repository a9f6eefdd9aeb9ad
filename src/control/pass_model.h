// What the occlusion pass is expected to gain at each size, learnt from the frames that were drawn.
#pragma once

#include "control/loss_budget.h"
#include "control/running_mean.h"
#include "control/selector_input.h"
#include "control/selector_rules.h"
#include "control/triangle_cost.h"

namespace eye {

class PassModel {
 public:
  explicit PassModel(const AdaptiveRules& rules);

  // The newest measurement; `sum` of the memberships when its frame was decided.
  void learn(const SelectorInput& input, double sum);
  // After a trial that went from off to a size or back: the two neighbouring runs tell what a triangle costs. False
  // where they are of two places.
  bool compareWithOff();

  // CPU time that a size would save against off at this sum of memberships; 0 for off.
  double gainMs(DepthMapChoice choice, double sum) const;
  DepthMapChoice bestSize(double sum) const;
  // Whether a trial of so many frames may be afforded, should it save nothing.
  bool affords(DepthMapChoice choice, int frames) const;
  // What may be lost is lost, and what is in use does not earn it back: it must go. A size that earns may stay, though
  // the trial that found it has used the budget up.
  bool overspent() const { return budget_.empty() && framesInUse_ >= settleFrames_ && provenGainMs_ <= 0; }

  // What a frame costs without the pass, measured or reckoned.
  double offMs() const { return offCostMs_.mean(); }
  // How many frames in a row, up to a few, were measured with what the newest one used.
  DepthMapChoice used() const { return used_; }
  int framesMeasured() const { return framesMeasured_; }

 private:
  bool isNear(double sum, double otherSum) const;
  double expectedShare(DepthMapChoice size, double sum) const;

  AdaptiveRules rules_;
  ValueBySize share_, passCostMs_;
  TriangleCost triangleCost_;
  LossBudget budget_;
  RunningMean offCostMs_, occluded_;
  RunningMedian drawOffMs_, drawOnMs_;  // drawing without the pass, and with it less the pass's own cost
  double submitted_ = 0;                // triangles, newest
  double provenGainMs_ = 0;             // of the newest frame
  bool shareMeasured_ = false;
  double measuredSum_ = 0, offSum_ = 0;  // of the frame whose share was measured last; of the last without the pass
  DepthMapChoice used_ = DepthMapChoice::off;
  int framesInUse_ = 0, framesMeasured_ = 0;
  int settleFrames_ = 0;  // of what is in use, before it is learnt from
};

}  // namespace eye
