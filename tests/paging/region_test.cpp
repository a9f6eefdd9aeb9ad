#include "paging/region.h"

#include <catch2/catch.hpp>
#include <map>
#include <random>
#include <set>

#include "paging/lod_select.h"
#include "paging/synthetic_forest.h"
#include "terrain/extent.h"

namespace eye {
namespace {

constexpr double kPi = 3.14159265358979;
constexpr double kLookUpRad = 40 * kPi / 180;  // within a second

Vec3d forwardOf(const View& view) {
  return glm::transpose(view.eyeFromEcef) * Vec3d(0, 0, 1);
}

ViewpointAhead aheadFrom(const View& view, double inS) {
  return {.inS = inS,
          .ecefM = view.eyeEcefM,
          .heightM = geodeticFromEcef(view.eyeEcefM).altM,
          .radius98M = 0,
          .forwardEcef = forwardOf(view),
          .turnRateRadS = 0};
}

RegionOptions optionsOf(const View& view) {
  RegionOptions options;
  options.pixelsPerRadian = pixelsPerRadian(view);
  options.ssePx = 2;
  options.halfFovRad = std::atan(std::hypot(view.frustum.tanRight, view.frustum.tanTop));
  return options;
}

// The slow twin: every viewpoint for every node, in the words of the header.
double neededIn(const ChunkMeta& meta, std::span<const ViewpointAhead> path, const RegionOptions& o,
                double hysteresis) {
  double soonest = INFINITY;
  for (const ViewpointAhead& at : path) {
    const double d = std::max(distanceToBox(at.ecefM, meta.box) - at.radius98M, 1.0);
    const Vec3d to = meta.sphereCentreEcefM - at.ecefM;
    double angle = 0;
    if (glm::length(to) > meta.sphereRadiusM + at.radius98M && d > 1) {
      angle = std::acos(std::clamp(glm::dot(glm::normalize(to), at.forwardEcef), -1.0, 1.0)) -
              std::asin(std::min(1.0, (meta.sphereRadiusM + at.radius98M) / glm::length(to))) -
              std::abs(at.turnRateRadS);
      angle = std::max(angle, 0.0);
    }
    const double area = angle < std::max(kPi / 4, o.halfFovRad) ? 1 : angle < 3 * kPi / 4 ? 2 : 4;
    const double errorPx = meta.geometricErrorM * o.pixelsPerRadian / d;
    const double texelPx = meta.texelErrorM * o.pixelsPerRadian / d;
    const double excess = std::max(errorPx / o.ssePx, texelPx / o.texelPx) / std::sqrt(area) * o.widening * hysteresis;
    const double downRad = std::acos(std::clamp(glm::dot(at.forwardEcef, -glm::normalize(at.ecefM)), -1.0, 1.0));
    const double limitM =
        o.widening * hysteresis * schedulingRadiusM(at.heightM, downRad + o.halfFovRad + kLookUpRad, 8850);
    if (excess >= 1 && d <= limitM)
      soonest = std::min(soonest, at.inS + std::max(angle - o.halfFovRad, 0.0) / (40 * kPi / 180));
  }
  return soonest;
}

}  // namespace

TEST_CASE("equations (7) and (8): from the nadir to the horizon, with the ground's own height and refraction") {
  CHECK(farthestGroundM(1219, 0) == Approx(133600).epsilon(0.001));   // 124.7 km without refraction
  CHECK(farthestGroundM(12192, 0) == Approx(423000).epsilon(0.001));  // 394 km
  CHECK(farthestGroundM(0, 0) == 0);
  CHECK(farthestGroundM(1000, 2000) == Approx(farthestGroundM(1000, 0) + farthestGroundM(2000, 0)));
  CHECK(schedulingRadiusM(1000, 0, 0) == Approx(1000));
  CHECK(schedulingRadiusM(1000, kPi / 3, 0) == Approx(2000));  // the slant way to L = tan(60) h
  CHECK(schedulingRadiusM(1000, kPi / 2, 0) == farthestGroundM(1000, 0));
  CHECK(schedulingRadiusM(1000, 1.5707, 0) == farthestGroundM(1000, 0));
  CHECK(schedulingRadiusM(1000, 2, 0) == farthestGroundM(1000, 0));
}

TEST_CASE("the walk plans what the definition says, no more and no less") {
  std::mt19937 random(3);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<>(a, b)(random); };
  size_t planned = 0, kept = 0;
  for (int round = 0; round < 40; ++round) {
    const double latDeg = uniform(-85, 85), lonDeg = uniform(-180, 180);
    TerrainCache cache = makeForest(around(latDeg, lonDeg, 3, 9), around(latDeg, lonDeg, 2, 3 + round % 6));
    cache.beginFrame();
    std::vector<ViewpointAhead> path;
    const double headingDeg = uniform(0, 360), altM = uniform(2000, 40000), speedMS = uniform(0, 2000);
    RegionOptions options;
    for (int i = 0; i < 8; ++i) {
      const double alongDeg = speedMS * i / 111000;
      const View view = makeView({{latDeg + alongDeg * std::cos(headingDeg * kPi / 180) * 0.5, lonDeg + alongDeg, altM},
                                  headingDeg + 5 * i,
                                  uniform(-70, 20),
                                  0},
                                 symmetricFrustum(60, 800, 600, 1), 800, 600);
      path.push_back(aheadFrom(view, i));
      path.back().radius98M = 600.0 * i;
      path.back().turnRateRadS = 0.05;
      options = optionsOf(view);
    }
    options.widening = round % 3 == 0 ? 1.5 : 1;
    RegionPlan plan;
    planRegion(cache, path, options, 100, 7, plan);

    std::map<TileKey, double> wanted;
    for (const GroupAhead& group : plan.wanted) wanted[group.parent] = group.neededInS;
    CHECK(std::ranges::is_sorted(plan.wanted, {}, &GroupAhead::neededInS));
    planned += wanted.size();
    // From the roots down, as far as nodes stay in the region.
    std::vector<uint32_t> open(cache.roots().begin(), cache.roots().end());
    while (!open.empty()) {
      const CacheNode& node = cache.node(open.back());
      open.pop_back();
      if (node.meta.childCount == 0) continue;
      const double inS = neededIn(node.meta, path, options, 1);
      const bool stays = std::isfinite(neededIn(node.meta, path, options, 1.15));
      INFO(node.meta.key.name());
      if (node.firstChild == CacheNode::kNoNode) {
        REQUIRE(wanted.contains(node.meta.key) == std::isfinite(inS));
        if (std::isfinite(inS)) REQUIRE(wanted[node.meta.key] == Approx(inS));
        continue;
      }
      for (const CacheNode& child : cache.children(*cache.find(node.meta.key))) {
        REQUIRE((child.plan == 7) == stays);
        if (stays) REQUIRE(child.neededAtS == Approx(100 + std::min(inS, path.back().inS)));
        kept += stays;
      }
      if (!stays) continue;
      for (uint32_t i = 0; i < cache.children(*cache.find(node.meta.key)).size(); ++i)
        open.push_back(node.firstChild + i);
    }
  }
  CHECK(planned > 200);
  CHECK(kept > 1000);
}

TEST_CASE("whatever the frame of a predicted viewpoint will miss is planned, at the latest for its time") {
  size_t missed = 0;
  for (uint32_t seed = 1; seed <= 60; ++seed) {
    const View later = randomView(seed);
    const Geodetic where = geodeticFromEcef(later.eyeEcefM);
    if (where.altM > 200'000) continue;  // a view of the whole disc reaches beyond the farthest ground from a low eye
    TerrainCache cache = makeForest(around(where.latDeg, where.lonDeg, 3, 8), around(where.latDeg, where.lonDeg, 2, 6));
    cache.beginFrame();
    std::vector<ViewpointAhead> path{aheadFrom(later, 0), aheadFrom(later, 4)};
    path[0].ecefM += Vec3d(3000, 2000, 1000);
    const RegionOptions options = optionsOf(later);
    RegionPlan plan;
    planRegion(cache, path, options, 0, 1, plan);
    std::map<TileKey, double> wanted;
    for (const GroupAhead& group : plan.wanted) wanted[group.parent] = group.neededInS;
    const double downRad = std::acos(glm::dot(forwardOf(later), -glm::normalize(later.eyeEcefM)));
    const double reachM = schedulingRadiusM(where.altM, downRad + options.halfFovRad + kLookUpRad, 8850);
    Selection selection;
    cache.beginFrame();
    selectChunks(cache, later, {.ssePx = options.ssePx}, selection);
    for (const WantedChunk& chunk : selection.wanted) {
      const ChunkMeta& meta = cache.node(*cache.find(*chunk.key.parent())).meta;
      // The frustum's test keeps more than can be seen; beyond the view's own reach nothing is planned.
      if (distanceToBox(later.eyeEcefM, meta.box) > reachM) continue;
      ++missed;
      INFO("seed " << seed << ": " << chunk.key.name());
      REQUIRE(wanted.contains(*chunk.key.parent()));
      CHECK(wanted[*chunk.key.parent()] <= 4);
    }
  }
  CHECK(missed > 100);
}

TEST_CASE("behind the view less is planned than in front, and later") {
  const TerrainCache made = makeForest(everywhereTo(7), everywhereTo(6));
  size_t groups[2] = {};
  double soonest[2] = {};
  for (int back = 0; back < 2; ++back) {
    TerrainCache cache = made;
    // The same point looked at from 40 km south of it, and turned away from.
    const View view =
        makeView({{10, 20, 8000}, back == 0 ? 0.0 : 180.0, 0, 0}, symmetricFrustum(60, 800, 600, 1), 800, 600);
    const std::vector<ViewpointAhead> path{aheadFrom(view, 0)};
    RegionPlan plan;
    planRegion(cache, path, optionsOf(view), 0, 1, plan);
    soonest[back] = INFINITY;
    for (const GroupAhead& group : plan.wanted) {
      const TileBounds b = group.parent.bounds();
      if ((b.southDeg + b.northDeg) / 2 < 11) continue;
      ++groups[back];
      soonest[back] = std::min(soonest[back], group.neededInS);
    }
  }
  CHECK(groups[0] > groups[1]);
  CHECK(groups[1] > 0);
  CHECK(soonest[0] == 0);
  CHECK(soonest[1] > 1);
}

}  // namespace eye
