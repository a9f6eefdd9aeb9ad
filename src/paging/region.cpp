#include "paging/region.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geo/frames.h"
#include "paging/lod_select.h"
#include "telemetry/trace.h"
#include "terrain/extent.h"

namespace eye {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRefraction = 0.13;
constexpr double kHighestGroundM = 8850;
constexpr double kNearestM = 1;
// A group stays in the region until it is this much farther than where it would come in, so that an eye that sways
// does not load and release in turns.
constexpr double kHysteresis = 1.15;
// Of a head or a camera: what lies outside the view is needed when a turn at this rate has brought it in.
constexpr double kHeadTurnRadS = 40 * kPi / 180;
// Equation (7) reaches as far as the view's upper edge: that of a view which looks up from now on, for so long as
// terrain takes to come.
constexpr double kLookUpS = 1;
// Half widths of the front and, beyond the sides, of the rear.
constexpr double kFrontRad = kPi / 4, kSidesRad = 3 * kPi / 4;

class RegionWalk {
 public:
  RegionWalk(TerrainCache& cache, std::span<const ViewpointAhead> path, const RegionOptions& options, double nowS,
             uint32_t plan, RegionPlan& out)
      : cache_(cache), path_(path), options_(options), nowS_(nowS), plan_(plan), out_(out) {
    for (const ViewpointAhead& at : path) {
      const double down = glm::dot(at.forwardEcef, -glm::normalize(at.ecefM));
      const double upperEdgeRad =
          std::acos(std::clamp(down, -1.0, 1.0)) + options.halfFovRad + kHeadTurnRadS * kLookUpS;
      radiiM_.push_back(options.widening * schedulingRadiusM(std::max(at.heightM, 0.0), upperEdgeRad, kHighestGroundM));
    }
  }

  void fromRoots() {
    for (uint32_t root : cache_.roots()) visit(root, ~uint32_t{0});
    std::ranges::stable_sort(out_.wanted, {}, &GroupAhead::neededInS);
  }

 private:
  // `viewpoints`, a bit each: those from which the parent's children are needed, or nearly so. From the others nothing
  // below is: it is farther away and its error smaller.
  void visit(uint32_t index, uint32_t viewpoints) {
    const CacheNode& node = cache_.node(index);
    if (node.meta.childCount == 0 || node.meta.key.level() >= kMaxLevel) return;
    ++out_.considered;
    const Need need = needOf(node.meta, viewpoints);
    if (need.viewpoints == 0) return;
    if (need.inS < kNever) {
      const double widthM = 2 * node.meta.sphereRadiusM / std::numbers::sqrt2;  // of the node; its children's are half
      out_.finestWidthM = out_.finestWidthM > 0 ? std::min(out_.finestWidthM, widthM / 2) : widthM / 2;
    }
    if (node.firstChild == CacheNode::kNoNode) {
      if (need.inS < kNever) out_.wanted.push_back({node.meta.key, need.inS});
      return;
    }
    const uint32_t first = node.firstChild;
    const auto count = static_cast<uint32_t>(cache_.children(index).size());
    for (uint32_t child = first; child < first + count; ++child) {
      CacheNode& member = cache_.node(child);
      member.plan = plan_;
      member.scheduledFrame = cache_.frame();
      member.neededAtS = nowS_ + std::min(need.inS, path_.back().inS);
    }
    for (uint32_t child = first; child < first + count; ++child) visit(child, need.viewpoints);
  }

  static constexpr double kNever = std::numeric_limits<double>::infinity();
  struct Need {
    double inS = kNever;
    uint32_t viewpoints = 0;  // from which it stays in the region
  };

  Need needOf(const ChunkMeta& meta, uint32_t viewpoints) const {
    Need need;
    const double showsAtM = options_.widening * options_.pixelsPerRadian *
                            std::max(meta.geometricErrorM / options_.ssePx, meta.texelErrorM / options_.texelPx);
    for (size_t i = 0; i < path_.size(); ++i) {
      if ((viewpoints & (1u << i)) == 0) continue;
      const ViewpointAhead& at = path_[i];
      const double distanceM = std::max(distanceToBox(at.ecefM, meta.box) - at.radius98M, kNearestM);
      if (distanceM > kHysteresis * std::min(showsAtM, radiiM_[i])) continue;  // not even in front
      const double aroundRad = angleFromView(at, meta, distanceM);
      // The square root: thresholds of area are taken on lengths. What is in the view is in front of it.
      const double sector = aroundRad < std::max(kFrontRad, options_.halfFovRad) ? 1
                            : aroundRad < kSidesRad                              ? std::numbers::sqrt2
                                                                                 : 2;
      const double reachM = std::min(showsAtM / sector, radiiM_[i]);
      if (distanceM > kHysteresis * reachM) continue;
      need.viewpoints |= 1u << i;
      if (distanceM > reachM) continue;
      need.inS = std::min(need.inS, at.inS + std::max(aroundRad - options_.halfFovRad, 0.0) / kHeadTurnRadS);
    }
    return need;
  }

  // Between the view's axis and the nearest part of the chunk's sphere, radians; less by what the aircraft turns on in
  // the second after.
  double angleFromView(const ViewpointAhead& at, const ChunkMeta& meta, double distanceM) const {
    const Vec3d toM = meta.sphereCentreEcefM - at.ecefM;
    const double centreM = glm::length(toM);
    if (centreM <= meta.sphereRadiusM + at.radius98M || distanceM <= kNearestM) return 0;
    const double axisRad = std::acos(std::clamp(glm::dot(toM, at.forwardEcef) / centreM, -1.0, 1.0));
    const double halfRad = std::asin(std::min((meta.sphereRadiusM + at.radius98M) / centreM, 1.0));
    return std::max(axisRad - halfRad - std::abs(at.turnRateRadS), 0.0);
  }

  TerrainCache& cache_;
  const std::span<const ViewpointAhead> path_;
  const RegionOptions& options_;
  const double nowS_;
  const uint32_t plan_;
  RegionPlan& out_;
  std::vector<double> radiiM_;  // by viewpoint
};

}  // namespace

double farthestGroundM(double heightM, double targetHeightM) {
  const double r = kMeanEarthRadiusM / (1 - kRefraction);
  // (r + h)² - r² without the squares of r, which would take the digits of low heights with them.
  const auto toHorizonM = [r](double h) { return std::sqrt(h * (2 * r + h)); };
  return toHorizonM(std::max(heightM, 0.0)) + toHorizonM(std::max(targetHeightM, 0.0));
}

double schedulingRadiusM(double heightM, double thetaRad, double targetHeightM) {
  const double mostM = farthestGroundM(heightM, targetHeightM);
  if (thetaRad >= kPi / 2) return mostM;
  // The slant distance that belongs to L, for the distances it is compared with are slant ones.
  return std::min(heightM / std::cos(thetaRad), mostM);
}

void planRegion(TerrainCache& cache, std::span<const ViewpointAhead> path, const RegionOptions& options, double nowS,
                uint32_t plan, RegionPlan& out) {
  const TraceScope trace("plan region");
  out.wanted.clear();
  out.considered = 0;
  out.finestWidthM = 0;
  EYE_CHECK(path.size() <= kMostViewpointsAhead);
  if (path.empty()) return;
  RegionWalk(cache, path, options, nowS, plan, out).fromRoots();
}

}  // namespace eye
