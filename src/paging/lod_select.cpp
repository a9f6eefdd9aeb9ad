#include "paging/lod_select.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "paging/across.h"
#include "paging/skirts.h"
#include "telemetry/trace.h"
#include "terrain/extent.h"

namespace eye {
namespace {

constexpr double kNearestM = 1e-3;  // an eye inside a box is this far from it, so that errors on screen stay finite
constexpr uint32_t kAllPlanes = 31;
constexpr uint32_t kNeverCull = 32;  // instead of planes: the horizon hides nothing either

class Walk {
 public:
  Walk(TerrainCache& cache, const View& view, const LodOptions& options, const Horizon& horizon, Selection& out)
      : cache_(cache),
        out_(out),
        horizon_(horizon),
        culls_(options.culling == CullingScheme::frustum),
        horizonTest_(options.horizon),
        eyeM_(view.eyeEcefM),
        planes_(frustumPlanes(view)),
        pixelsPerRadian_(pixelsPerRadian(view)),
        ssePx_(options.ssePx),
        texelPx_(options.texelPx),
        coarsening_(options.coarsening) {}

  void fromRoots() {
    for (uint32_t root : cache_.roots()) visit(root, kAllPlanes, 0);
  }

  // Walks into what lies outside the frustum but across an edge of a chunk drawn too coarsely: such an edge may be off
  // by more than the margin that was kept. What this draws may be too coarse itself: the list grows while it is gone
  // over.
  void reviveBesideCoarse() {
    if (!culls_) return;
    for (size_t i = 0; i < out_.coarse.size(); ++i) {
      const uint32_t node = out_.coarse[i].node;
      const double errorM = cache_.node(node).meta.geometricErrorM;
      for (Side side : kSides) forEachAcross(cache_, node, side, [&](uint32_t other) { revive(other, errorM); });
    }
  }

  // A side beside which the columns double has two neighbours, and its skirt is as deep as both need: where one of them
  // is seen the other counts as if it were, so that what is left out changes no skirt.
  void reviveHalfSides() {
    if (!culls_) return;
    const size_t seen = out_.walked.size();
    for (size_t i = 0; i < seen; ++i) {
      const uint32_t node = out_.walked[i].node;
      for (Side side : kSides) {
        across_.clear();
        forEachAcross(cache_, node, side, [&](uint32_t other) { across_.push_back(other); });
        const auto culled = std::ranges::partition(across_, [&](uint32_t other) { return !isCulled(other); });
        if (culled.size() == across_.size()) continue;
        for (uint32_t other : culled) uncull(other);
      }
    }
  }

  // How far under the ellipsoid the drawn terrain reaches between eye and horizon.
  double greatestDepthM() const { return greatestDepthM_; }

 private:
  // `neighbourErrorM`: of a neighbour known to be off by more than the tolerance.
  void visit(uint32_t index, uint32_t planes, double neighbourErrorM) {
    CacheNode& node = cache_.node(index);
    const ChunkMeta& meta = node.meta;
    node.usedFrame = cache_.frame();
    ++out_.counts.considered;
    const bool mayCull = culls_ && planes != kNeverCull;
    if (mayCull && isOutside(meta, neighbourErrorM, planes)) {
      node.visit = Visit::outsideFrustum;
      ++out_.counts.frustumCulled;
      return;
    }
    if (mayCull && horizon_.hides(meta, horizonTest_)) {
      node.visit = Visit::belowHorizon;
      ++out_.counts.horizonCulled;
      return;
    }
    const double distanceM = distanceToBox(eyeM_, meta.box);
    const double pixelsPerM = pixelsPerRadian_ / std::max(distanceM, kNearestM);
    const double excess =
        std::max(meta.geometricErrorM * pixelsPerM / ssePx_, meta.texelErrorM * pixelsPerM / texelPx_);
    if (excess > coarsening_ && node.firstChild != CacheNode::kNoNode) {
      node.visit = Visit::refined;
      const uint32_t first = node.firstChild;
      const auto count = static_cast<uint32_t>(cache_.children(index).size());
      for (uint32_t child = first; child < first + count; ++child) visit(child, planes, neighbourErrorM);
      return;
    }
    node.visit = Visit::drawn;
    if (excess > 1) {
      const bool hasChildren = meta.childCount > 0 && meta.key.level() < kMaxLevel;
      out_.coarse.push_back({index, static_cast<float>(excess), static_cast<float>(distanceM), hasChildren});
    }
    if (distanceM < horizon_.reachM())
      greatestDepthM_ = std::max(greatestDepthM_, meta.geometricErrorM - meta.minHeightM);
    out_.walked.push_back({.node = index,
                           .distanceM = distanceM,
                           .skirtMask = 0,
                           .skirtDepthM = {},
                           .textureNode = node.textureNode,
                           .textureScale = node.textureScale,
                           .textureOffset = node.textureOffset});
  }

  // Whether the chunk, its descendants (within twice its error of its mesh) and their skirts are all behind one plane.
  // `planes`: those that still cut; the ones behind which nothing lies are taken out for the descendants.
  bool isOutside(const ChunkMeta& meta, double neighbourErrorM, uint32_t& planes) const {
    if (planes == 0) return false;
    const Vec3d centreM = meta.box.centreEcefM - eyeM_;
    const double farthestM = glm::length(meta.sphereCentreEcefM - eyeM_) + meta.sphereRadiusM;
    const double toleratedM = std::max(ssePx_ * farthestM / pixelsPerRadian_, neighbourErrorM);
    const double marginM = 2 * meta.geometricErrorM + kSkirtReach * std::max(meta.geometricErrorM, toleratedM);
    for (size_t i = 0; i < planes_.normalsEcef.size(); ++i) {
      if ((planes & (1u << i)) == 0) continue;
      const Vec3d& normal = planes_.normalsEcef[i];
      const double distanceM = glm::dot(normal, centreM) - planes_.offsetsM[i];
      const double reachM = marginM + std::abs(glm::dot(normal, meta.box.halfAxesEcefM[0])) +
                            std::abs(glm::dot(normal, meta.box.halfAxesEcefM[1])) +
                            std::abs(glm::dot(normal, meta.box.halfAxesEcefM[2]));
      if (distanceM < -reachM) return true;
      if (distanceM > reachM) planes &= ~(1u << i);
    }
    return false;
  }

  void revive(uint32_t index, double neighbourErrorM) {
    const CacheNode& node = cache_.node(index);
    if (node.visit == Visit::refined) {
      const uint32_t first = node.firstChild;
      const auto count = static_cast<uint32_t>(cache_.children(index).size());
      for (uint32_t child = first; child < first + count; ++child) revive(child, neighbourErrorM);
    } else if (node.visit == Visit::outsideFrustum) {
      --out_.counts.considered;
      --out_.counts.frustumCulled;
      visit(index, kAllPlanes, neighbourErrorM);
    }
  }

  bool isCulled(uint32_t index) const {
    const Visit visit = cache_.node(index).visit;
    return visit == Visit::outsideFrustum || visit == Visit::belowHorizon;
  }

  void uncull(uint32_t index) {
    if (!isCulled(index)) return;  // met twice
    --out_.counts.considered;
    --(cache_.node(index).visit == Visit::outsideFrustum ? out_.counts.frustumCulled : out_.counts.horizonCulled);
    visit(index, kNeverCull, 0);
  }

  TerrainCache& cache_;
  Selection& out_;
  const Horizon& horizon_;
  const bool culls_;
  const HorizonTest horizonTest_;
  const Vec3d eyeM_;
  const FrustumPlanes planes_;
  const double pixelsPerRadian_, ssePx_, texelPx_, coarsening_;
  double greatestDepthM_ = 0;
  std::vector<uint32_t> across_;
};

Horizon firstHorizon(const TerrainCache& cache, const View& view, const LodOptions& options) {
  double greatestErrorM = 0;  // errors fall from parent to child
  for (uint32_t root : cache.roots()) greatestErrorM = std::max(greatestErrorM, cache.node(root).meta.geometricErrorM);
  return horizonForTolerance(view.eyeEcefM, greatestErrorM, options.ssePx / pixelsPerRadian(view));
}

// Positive doubles order like their bits; the low ones make room for the index, so that a sort moves eight bytes.
void sortFrontToBack(Selection& out) {
  EYE_CHECK(out.walked.size() < (size_t{1} << 20));
  out.order.clear();
  for (size_t i = 0; i < out.walked.size(); ++i)
    out.order.push_back((std::bit_cast<uint64_t>(out.walked[i].distanceM) & ~uint64_t{0xFFFFF}) | i);
  std::ranges::sort(out.order);
  out.draws.clear();
  for (uint64_t entry : out.order) out.draws.push_back(out.walked[entry & 0xFFFFF]);
}

void listWanted(const TerrainCache& cache, double coarsening, Selection& out) {
  out.wanted.clear();
  std::erase_if(out.coarse, [](const Selection::Coarse& c) { return !c.childrenMissing; });
  out.counts.missing = static_cast<uint32_t>(out.coarse.size());
  std::ranges::sort(out.coarse, [&](const Selection::Coarse& a, const Selection::Coarse& b) {
    if (a.priority != b.priority) return a.priority > b.priority;
    if (a.distanceM != b.distanceM) return a.distanceM < b.distanceM;
    return cache.node(a.node).meta.key.code() < cache.node(b.node).meta.key.code();
  });
  for (const Selection::Coarse& coarse : out.coarse) {
    if (coarse.priority <= static_cast<float>(coarsening)) break;
    for (const TileKey& child : cache.node(coarse.node).meta.key.children())
      out.wanted.push_back({child, coarse.priority});
  }
}

}  // namespace

void selectChunks(TerrainCache& cache, const View& view, const LodOptions& options, Selection& out) {
  const TraceScope trace("select chunks");
  Horizon horizon = firstHorizon(cache, view, options);
  // Again with a lower ellipsoid where a sea's floor or something coarse, such as a root while its children are on
  // their way, sags below it: each time by more, the roots' error at most. With all in that is within the tolerance,
  // the first walk stands. A frame of its own for each, lest the last one's marks be taken for its own.
  for (;;) {
    out.walked.clear();
    out.coarse.clear();
    out.counts = {};
    Walk walk(cache, view, options, horizon, out);
    walk.fromRoots();
    walk.reviveBesideCoarse();
    walk.reviveHalfSides();
    if (options.horizon == HorizonTest::none || walk.greatestDepthM() <= horizon.depthM()) break;
    horizon = Horizon(view.eyeEcefM, walk.greatestDepthM());
    cache.beginFrame();
  }
  out.hidesBelowHorizon =
      options.horizon != HorizonTest::none && horizon.reachM() > 0 && horizon.depthM() <= kDeepestGroundM;
  out.counts.drawn = static_cast<uint32_t>(out.walked.size());
  sortFrontToBack(out);
  assignSkirts(cache, out.draws);
  listWanted(cache, options.coarsening, out);
}

}  // namespace eye
