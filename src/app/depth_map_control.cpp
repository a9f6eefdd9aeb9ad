#include "app/depth_map_control.h"

#include <algorithm>
#include <string_view>

#include "control/selector_rules.h"

namespace eye {
namespace {

// What hides the rest of the view is mostly within so far.
constexpr double kNearM = 20000;
// The passes that occlusion culling adds, by the names of their times.
constexpr std::array<std::string_view, 3> kPasses{"cull_early", "depth_map", "cull_late"};

// And those that draw, with it or without; uploads, read-back and overlay have nothing to do with the choice. Where
// cost is CPU time they are in it, the same with either choice.
constexpr std::array<std::string_view, 3> kDrawing{"scene", "early", "late"};

// Middle of the finest resident tile's heights under the eye.
double groundHeightM(const TerrainCache& cache, const Geodetic& eye) {
  double heightM = 0;
  for (int level = 0; level <= kMaxLevel; ++level) {
    const std::optional<uint32_t> node = cache.find(TileKey::containing(eye.latDeg, eye.lonDeg, level));
    if (!node) break;
    const ChunkMeta& meta = cache.node(*node).meta;
    heightM = (meta.minHeightM + meta.maxHeightM) / 2;
  }
  return heightM;
}

}  // namespace

Surroundings surroundingsOf(const TerrainCache& cache, const Selection& selection, const Geodetic& eye) {
  double lowestM = 0, highestM = 0;
  bool any = false;
  for (const DrawnChunk& drawn : selection.draws) {  // front to back
    if (drawn.distanceM > kNearM) break;
    const ChunkMeta& meta = cache.node(drawn.node).meta;
    lowestM = any ? std::min(lowestM, meta.minHeightM) : meta.minHeightM;
    highestM = any ? std::max(highestM, meta.maxHeightM) : meta.maxHeightM;
    any = true;
  }
  return {.heightAboveGroundM = eye.altM - groundHeightM(cache, eye), .reliefM = highestM - lowestM};
}

Result<DepthMapControl> DepthMapControl::create(const Options& options) {
  DepthMapControl control;
  control.culling_ = options.culling;
  control.mode_ = options.depthMap;
  control.fixedPx_ = options.depthMapPx;
  SelectorRules rules;
  if (!options.selectorRules.empty()) {
    const Result<SelectorRules> loaded = loadSelectorRules(options.selectorRules);
    if (!loaded) return tl::unexpected(loaded.error());
    rules = *loaded;
  }
  if (options.selectorMode) rules.mode = *options.selectorMode;
  control.selector_ = FuzzySelector(rules);
  return control;
}

std::optional<glm::ivec2> DepthMapControl::choose(const Pose& pose, const TerrainCache& cache,
                                                  const Selection& selection) {
  decision_.reset();
  if (culling_ != CullingMode::dynamic || mode_ == DepthMapMode::off) return std::nullopt;
  if (mode_ == DepthMapMode::fixed) return fixedPx_;
  const Surroundings around = surroundingsOf(cache, selection, pose.position);
  SelectorInput input = measured_;
  input.heightAboveGroundM = around.heightAboveGroundM;
  input.reliefM = around.reliefM;
  input.altitudeMslM = pose.position.altM;
  input.pitchDeg = pose.pitchDeg;
  decision_ = selector_.decide(input);
  measured_ = {};
  measured_.used = decision_->choice;
  if (decision_->choice == DepthMapChoice::off) return std::nullopt;
  const DepthMapSize size = sizeOf(decision_->choice);
  return glm::ivec2(size.widthPx, size.heightPx);
}

void DepthMapControl::learn(const FrameOutput& output, double pagingMs) {
  if (!decision_) return;
  if (!output.depthMapPx) measured_.used = DepthMapChoice::off;  // nothing was in view to test
  measured_.submittedTriangles = output.triangles + output.clusters.trianglesSpared;
  measured_.occludedTriangles = output.clusters.trianglesSpared;
  for (const PassTime& pass : output.passes) {
    const bool isAdded = std::ranges::find(kPasses, pass.name) != kPasses.end();
    const bool isDrawing = std::ranges::find(kDrawing, pass.name) != kDrawing.end();
    if (isAdded) measured_.passCostMs += pass.ms;
    if (isAdded || isDrawing) measured_.frameCostMs += pass.ms;
  }
  // On a device that is a CPU passes last as long as whatever else runs lets them: what they cost is CPU time.
  if (output.cpuMs > 0) {
    measured_.frameCostMs = std::max(output.cpuMs - pagingMs, 0.0);
    if (measured_.used != DepthMapChoice::off)
      measured_.passCostMs = std::min(pass_.observe(measured_.used, measured_.passCostMs), measured_.frameCostMs);
  }
}

}  // namespace eye
