// The selector that learns: paper 001's form over better inputs, with trials.
//
// Memberships of height over relief and of pitch, weighted and summed, stand for a share of hidden triangles until one
// is measured (pass_model.h); the size that is expected to gain most over its cost is held, or off where none gains.
// Every so often something else is tried for a few frames: at off a size, at a size off and its neighbours; the longer
// nothing changes, the more seldom, and sooner where the memberships promise a gain or are no longer those of the last
// trial. What all this may lose is limited by a budget. Time is counted in calls: one a frame.
#pragma once

#include <optional>

#include "control/pass_model.h"

namespace eye {

class AdaptiveSelector {
 public:
  explicit AdaptiveSelector(const AdaptiveRules& rules);
  Decision decide(const SelectorInput& input);

 private:
  struct Trial {
    DepthMapChoice choice;
    int frames;  // since it began
  };

  DepthMapChoice choose(double sum);
  int ownFrames() const { return rules_.settleFrames + rules_.trialFrames; }
  void concludeTrial(bool measured, double sum);
  void reconsider(double sum);
  void hold(DepthMapChoice choice);
  std::optional<DepthMapChoice> dueTrial(double sum);
  DepthMapChoice nextAlternative();

  AdaptiveRules rules_;
  PassModel model_;
  double decidedSum_ = 0;  // of the newest decision
  double triedSum_ = 0;    // of the newest trial
  DepthMapChoice held_ = DepthMapChoice::off;
  std::optional<Trial> trial_;
  int framesHeld_ = 0, framesSinceTrial_ = 0, intervalFrames_ = 0;
  int turn_ = 0;  // which alternative to the held size is tried next
};

}  // namespace eye
