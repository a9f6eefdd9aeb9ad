// Which depth map each frame's occlusion culling gets, if any: what the options say, or the fuzzy selector from the
// eye's surroundings and the last frame's measurements. Owner thread: render.
#pragma once

#include <optional>

#include "app/options.h"
#include "control/fuzzy_selector.h"
#include "control/shortest_pass.h"
#include "geo/pose.h"
#include "paging/lod_select.h"
#include "render/renderer.h"

namespace eye {

// Terrain about the eye, from what is resident.
struct Surroundings {
  double heightAboveGroundM = 0;
  double reliefM = 0;  // highest minus lowest terrain among the chunks in view and near
};
Surroundings surroundingsOf(const TerrainCache& cache, const Selection& selection, const Geodetic& eye);

class DepthMapControl {
 public:
  // usage: a rules file that does not hold (says where).
  static Result<DepthMapControl> create(const Options& options);

  // Before a frame that is drawn: the size of its depth map, nothing for none.
  std::optional<glm::ivec2> choose(const Pose& pose, const TerrainCache& cache, const Selection& selection);
  // After it. `pagingMs`: CPU time that the paging thread took meanwhile, which the choice does not change.
  void learn(const FrameOutput& output, double pagingMs);
  // The selector's; nothing where the options decide.
  const std::optional<Decision>& decision() const { return decision_; }

 private:
  CullingMode culling_ = CullingMode::dynamic;
  DepthMapMode mode_ = DepthMapMode::automatic;
  glm::ivec2 fixedPx_{0, 0};
  FuzzySelector selector_;
  SelectorInput measured_;  // of the last frame
  ShortestPass pass_;       // on a device that is a CPU
  std::optional<Decision> decision_;
};

}  // namespace eye
