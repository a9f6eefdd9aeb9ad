// Off-axis frusta: channels that tile a wide view draw what it draws, and the planes never cull what is in view.
#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <set>

#include "paging/lod_select.h"
#include "paging/synthetic_forest.h"

namespace eye {
namespace {

constexpr int kLevel = 7;
constexpr double kPixelsPerTangent = 400;  // the same in every channel: so are the levels

struct Channel {
  double leftDeg, rightDeg, bottomDeg, topDeg;
};

View viewOf(const Channel& c, const View& like) {
  View view = like;
  view.frustum = offAxisFrustum(c.leftDeg, c.rightDeg, c.bottomDeg, c.topDeg, 1);
  view.widthPx = static_cast<int>(kPixelsPerTangent * (view.frustum.tanRight - view.frustum.tanLeft));
  view.heightPx = static_cast<int>(kPixelsPerTangent * (view.frustum.tanTop - view.frustum.tanBottom));
  return view;
}

// By the angles themselves, not by planes: in front of the near plane and between the edges.
bool isInView(const View& view, const Vec3d& pointEcefM) {
  const Vec3d p = view.eyeFromEcef * (pointEcefM - view.eyeEcefM);
  const Frustum& f = view.frustum;
  return p.z >= f.nearM && p.x >= f.tanLeft * p.z && p.x <= f.tanRight * p.z && -p.y >= f.tanBottom * p.z &&
         -p.y <= f.tanTop * p.z;
}

// Whether any of a lattice of points on and in the box is in view, moved towards the middle of the view by `marginM`.
bool showsInView(const View& view, const OrientedBox& box, double marginM) {
  constexpr int kSteps = 6;
  const Frustum& f = view.frustum;
  const Vec3d middle = glm::transpose(view.eyeFromEcef) *
                       glm::normalize(Vec3d((f.tanLeft + f.tanRight) / 2, -(f.tanBottom + f.tanTop) / 2, 1));
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      for (int k = 0; k <= kSteps; ++k) {
        const Vec3d at = Vec3d(i, j, k) * (2.0 / kSteps) - 1.0;
        const Vec3d pointM =
            box.centreEcefM + at.x * box.halfAxesEcefM[0] + at.y * box.halfAxesEcefM[1] + at.z * box.halfAxesEcefM[2];
        const Vec3d inwards = view.eyeEcefM + (glm::length(pointM - view.eyeEcefM) + 1) * middle - pointM;
        if (isInView(view, pointM + marginM * glm::normalize(inwards))) return true;
      }
    }
  }
  return false;
}

TerrainCache forestAbout(const View& view) {
  const Geodetic eye = geodeticFromEcef(view.eyeEcefM);
  return makeForest(around(eye.latDeg, eye.lonDeg, 3, kLevel), [](const TileKey&) { return true; });
}

std::set<uint32_t> drawnNodes(TerrainCache& cache, const View& view) {
  Selection selection;
  cache.beginFrame();
  selectChunks(cache, view, {.ssePx = 4}, selection);
  std::set<uint32_t> nodes;
  for (const DrawnChunk& draw : selection.draws) nodes.insert(draw.node);
  return nodes;
}

// Whether the last walk stopped at the node or above it because the Earth hides it.
bool isBelowHorizon(const TerrainCache& cache, uint32_t node) {
  while (cache.node(node).usedFrame != cache.frame()) node = cache.node(node).parent;
  return cache.node(node).visit == Visit::belowHorizon;
}

}  // namespace

TEST_CASE("channels that tile a wide view draw the chunks that it draws") {
  const std::vector<Channel> wides{{-60, 60, -20, 20}, {-75, 75, -35, 10}, {-50, 50, -40, 40}};
  const std::vector<std::vector<Channel>> tilings{
      {{-60, -20, -20, 20}, {-20, 20, -20, 20}, {20, 60, -20, 20}},              // side by side
      {{-75, -10, -35, 10}, {-10, 5, -35, 10}, {5, 75, -35, 10}},                // of unequal widths
      {{-50, 10, 5, 40}, {10, 50, 5, 40}, {-50, 10, -40, 5}, {10, 50, -40, 5}},  // two by two
  };
  size_t same = 0, onlyWide = 0, onlyChannels = 0;
  for (uint32_t seed = 0; seed < 120; ++seed) {
    const View like = randomView(seed);
    TerrainCache cache = forestAbout(like);
    const View wide = viewOf(wides[seed % 3], like);
    const std::set<uint32_t> drawn = drawnNodes(cache, wide);
    std::set<uint32_t> united;
    for (const Channel& channel : tilings[seed % 3]) united.merge(drawnNodes(cache, viewOf(channel, like)));
    // The planes' test is on the safe side: near a frustum's edges one of them may keep what the other leaves out. That
    // is never in view, nor is half of a side that is kept for the other half's sake: it may lie below the horizon.
    const auto checkUnseen = [&](const View& view, const std::set<uint32_t>& nodes) {
      const std::set<uint32_t> kept = drawnNodes(cache, view);
      for (const uint32_t node : nodes) {
        if (kept.contains(node) || isBelowHorizon(cache, node)) continue;
        INFO("seed " << seed << ": " << cache.node(node).meta.key.name());
        REQUIRE_FALSE(showsInView(view, cache.node(node).meta.box, 0));
      }
    };
    checkUnseen(wide, united);
    for (const Channel& channel : tilings[seed % 3]) checkUnseen(viewOf(channel, like), drawn);
    for (const uint32_t node : drawn) ++(united.contains(node) ? same : onlyWide);
    for (const uint32_t node : united) onlyChannels += !drawn.contains(node);
  }
  CAPTURE(same, onlyWide, onlyChannels);
  CHECK(same > 1500);
  CHECK(onlyWide + onlyChannels < same / 50);
}

TEST_CASE("an off-axis frustum with equal halves draws what the symmetric one draws") {
  for (uint32_t seed = 0; seed < 20; ++seed) {
    View view = randomView(seed);
    TerrainCache cache = forestAbout(view);
    view.frustum = symmetricFrustum(60, view.widthPx, view.heightPx, 1);
    const double upDeg = degFromRad(std::atan(view.frustum.tanTop));
    View offAxis = view;
    offAxis.frustum = offAxisFrustum(-30, 30, -upDeg, upDeg, 1);
    CHECK(drawnNodes(cache, view) == drawnNodes(cache, offAxis));
  }
}

TEST_CASE(
    "the planes of no off-axis frustum cull a chunk of which a point, or one of its descendants', may be in view") {
  std::mt19937 random(5);
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  size_t culled = 0, wrong = 0;
  for (uint32_t seed = 0; seed < 150; ++seed) {
    const View like = randomView(seed);
    TerrainCache cache = forestAbout(like);
    for (int i = 0; i < 4; ++i) {
      // Some far off the axis, some slivers.
      const double leftDeg = uniform(-89, 88), bottomDeg = uniform(-89, 88);
      const View view = viewOf(
          {leftDeg, leftDeg + uniform(0.5, 89 - leftDeg), bottomDeg, bottomDeg + uniform(0.5, 89 - bottomDeg)}, like);
      Selection selection;
      cache.beginFrame();
      selectChunks(cache, view, {.ssePx = 20}, selection);
      std::vector<uint32_t> open(cache.roots().begin(), cache.roots().end());
      while (!open.empty()) {
        const uint32_t index = open.back();
        open.pop_back();
        const CacheNode& node = cache.node(index);
        if (node.visit == Visit::refined)
          for (uint32_t c = 0; c < cache.children(index).size(); ++c) open.push_back(node.firstChild + c);
        if (node.visit != Visit::outsideFrustum) continue;
        ++culled;
        wrong += showsInView(view, node.meta.box, 2 * node.meta.geometricErrorM);
      }
    }
  }
  CHECK(culled > 10'000);
  CHECK(wrong == 0);
}

}  // namespace eye
