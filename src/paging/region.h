// The scheduling region: what lies around the predicted viewpoint and is needed before long (papers 000 and 003).
// Pure but for the marks that it leaves in the cache for eviction. Owner thread: render.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "paging/terrain_cache.h"

namespace eye {

inline constexpr size_t kMostViewpointsAhead = 32;

// A viewpoint to come.
struct ViewpointAhead {
  double inS = 0;  // from now, not negative
  Vec3d ecefM{};
  double heightM = 0;       // above the ellipsoid
  double radius98M = 0;     // the viewpoint is within this distance of ecefM with a probability of 98 %
  Vec3d forwardEcef{};      // unit, where the view looks
  double turnRateRadS = 0;  // about the vertical
};

// Distances beyond which nothing is scheduled, metres. Equation (7), L = tan(theta) h, with theta the angle from the
// nadir up to the view's upper edge, and never more than equation (8)'s farthest ground, which stands `targetHeightM`
// high, over an Earth that refraction flattens by k = 0.13.
double schedulingRadiusM(double heightM, double thetaRad, double targetHeightM);
double farthestGroundM(double heightM, double targetHeightM);

struct RegionOptions {
  double pixelsPerRadian = 800;  // of the view, with its tolerances
  double ssePx = 1, texelPx = 4;
  double halfFovRad = 0.7;  // from the view's axis to its farthest corner
  // Distances count as divided by this. 1 is what is needed; more gives a margin, as a strategy without prediction
  // wants.
  double widening = 1;
};

// A group that is not resident and will be needed.
struct GroupAhead {
  TileKey parent;
  double neededInS = 0;
};

struct RegionPlan {
  std::vector<GroupAhead> wanted;  // soonest first
  uint32_t considered = 0;         // nodes
  double finestWidthM = 0;         // of the smallest chunk that is needed; 0: none
};

// Walks the resident forest. `path`: at most kMostViewpointsAhead, in the order of time, the first one now. A node's
// children are needed when its error shows from one of `path`'s viewpoints, at the soonest of these: in front of it by
// the view's own tolerance, at its sides by twice and behind it by four times the projected area (paper 000: S_front =
// S_sides / 2 = S_rear / 4), and outside the view not before a head could turn there. Groups that are needed, or were
// but for a margin of 15 % of distance, are marked: `neededAtS` of their members is `nowS` + that time, `plan` their
// stamp and `scheduledFrame` the cache's frame.
void planRegion(TerrainCache& cache, std::span<const ViewpointAhead> path, const RegionOptions& options, double nowS,
                uint32_t plan, RegionPlan& out);

}  // namespace eye
