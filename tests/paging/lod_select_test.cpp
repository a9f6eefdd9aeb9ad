#include "paging/lod_select.h"

#include <catch2/catch.hpp>
#include <map>
#include <random>
#include <set>

#include "paging/across.h"
#include "paging/synthetic_forest.h"

namespace eye {
namespace {

constexpr int kLevel = 7;

// Some of the fine forest: what a pager may have at any moment.
TerrainCache makeRandomForest(uint32_t seed, const View& view) {
  const Geodetic eye = geodeticFromEcef(view.eyeEcefM);
  const IsRefined baked = around(eye.latDeg, eye.lonDeg, 3, kLevel);
  return makeForest(baked, [seed](const TileKey& key) {
    std::mt19937_64 random(key.code() * 977 + seed);
    random.discard(3);
    return seed % 3 == 0 || key.level() < 2 || random() % 10 < 8;
  });
}

Selection select(TerrainCache& cache, const View& view, CullingScheme culling, double ssePx = 20,
                 HorizonTest horizon = HorizonTest::ellipsoid) {
  Selection selection;
  cache.beginFrame();
  selectChunks(cache, view, {.ssePx = ssePx, .culling = culling, .horizon = horizon}, selection);
  return selection;
}

// How far outside the view a point lies: the distance to the plane that it is farthest behind; negative inside.
double outsideFrustumM(const View& view, const Vec3d& pointEcefM) {
  const FrustumPlanes planes = frustumPlanes(view);
  double outsideM = -1e12;
  for (size_t i = 0; i < planes.normalsEcef.size(); ++i)
    outsideM = std::max(outsideM, planes.offsetsM[i] - glm::dot(planes.normalsEcef[i], pointEcefM - view.eyeEcefM));
  return outsideM;
}

bool isBelowHorizon(const View& view, const Vec3d& pointEcefM) {
  const Vec3d axes(kSemiMajorM, kSemiMajorM, kSemiMinorM);
  return belowHorizon(view.eyeEcefM / axes, pointEcefM / axes);
}

std::map<TileKey, const DrawnChunk*> byKey(const TerrainCache& cache, const Selection& selection) {
  std::map<TileKey, const DrawnChunk*> drawn;
  for (const DrawnChunk& draw : selection.draws) drawn[cache.node(draw.node).meta.key] = &draw;
  return drawn;
}

// The drawn chunk that holds the point; null where none does.
const DrawnChunk* drawnAt(const std::map<TileKey, const DrawnChunk*>& drawn, double latDeg, double lonDeg) {
  for (int level = 0; level <= kLevel; ++level) {
    const auto found = drawn.find(TileKey::containing(latDeg, lonDeg, level));
    if (found != drawn.end()) return found->second;
  }
  return nullptr;
}

struct EdgePoint {
  LatLon edge, across;  // on the side, and a little beyond it
};
std::vector<EdgePoint> pointsAlong(const TileKey& key, Side side) {
  const TileBounds b = key.bounds();
  const double outDeg = 1e-3 * (b.northDeg - b.southDeg);
  std::vector<EdgePoint> points;
  for (int i = 1; i < 16; ++i) {
    const double along = i / 16.0;
    const bool isMeridian = side == Side::east || side == Side::west;
    LatLon p{side == Side::south ? b.southDeg : b.northDeg, std::lerp(b.westDeg, b.eastDeg, along)};
    if (isMeridian) p = {std::lerp(b.southDeg, b.northDeg, along), side == Side::east ? b.eastDeg : b.westDeg};
    LatLon across = p;
    if (isMeridian) across.lonDeg = std::remainder(p.lonDeg + (side == Side::east ? outDeg : -outDeg), 360.0);
    if (!isMeridian) across.latDeg += side == Side::north ? outDeg : -outDeg;
    if (std::abs(across.latDeg) < 90) points.push_back({p, across});
  }
  return points;
}

}  // namespace

TEST_CASE("without culling every place is drawn exactly once, and too coarse only where children are missing") {
  for (uint32_t seed = 0; seed < 40; ++seed) {
    const View view = randomView(seed);
    TerrainCache cache = makeRandomForest(seed, view);
    const Selection selection = select(cache, view, CullingScheme::none);
    std::set<uint32_t> drawn;
    for (const DrawnChunk& draw : selection.draws) REQUIRE(drawn.insert(draw.node).second);

    struct Open {
      uint32_t node;
      int drawnAbove;
    };
    std::vector<Open> open;
    for (uint32_t root : cache.roots()) open.push_back({root, 0});
    while (!open.empty()) {
      const Open at = open.back();
      open.pop_back();
      const int count = at.drawnAbove + (drawn.contains(at.node) ? 1 : 0);
      REQUIRE(count <= 1);
      const uint32_t first = cache.node(at.node).firstChild;
      if (first == CacheNode::kNoNode) REQUIRE(count == 1);
      for (uint32_t i = 0; i < cache.children(at.node).size(); ++i) open.push_back({first + i, count});
    }
    uint32_t missing = 0;
    for (const DrawnChunk& draw : selection.draws) {
      const CacheNode& node = cache.node(draw.node);
      const double errorPx = node.meta.geometricErrorM * pixelsPerRadian(view) / std::max(draw.distanceM, 1e-3);
      if (errorPx > 20) REQUIRE(node.firstChild == CacheNode::kNoNode);
      if (errorPx > 20 && node.meta.childCount > 0) ++missing;
    }
    CHECK(selection.counts.missing == missing);
  }
}

TEST_CASE("draws are front to back; what is wanted is in groups, most urgent first") {
  size_t groups = 0;
  for (uint32_t seed = 1; seed < 150; ++seed) {
    const View view = randomView(seed);
    TerrainCache cache = makeRandomForest(seed, view);
    const Selection selection = select(cache, view, CullingScheme::frustum);
    for (size_t i = 1; i < selection.draws.size(); ++i)
      REQUIRE(selection.draws[i - 1].distanceM <= selection.draws[i].distanceM * (1 + 1e-9));
    std::set<TileKey> seen;
    for (size_t i = 0; i < selection.wanted.size(); ++groups) {
      const TileKey parent = *selection.wanted[i].key.parent();
      REQUIRE(cache.find(parent).has_value());
      REQUIRE(seen.insert(parent).second);
      if (i > 0) REQUIRE(selection.wanted[i - 1].priority >= selection.wanted[i].priority);
      REQUIRE(selection.wanted[i].priority > 1);
      for (const TileKey& child : parent.children()) {
        REQUIRE(selection.wanted[i].key == child);
        REQUIRE_FALSE(cache.find(child).has_value());
        ++i;
      }
    }
  }
  CHECK(groups > 100);
}

TEST_CASE("culling leaves out only what cannot be seen") {
  const HorizonTest horizon = GENERATE(HorizonTest::ellipsoid, HorizonTest::paper);
  size_t outside = 0, below = 0;
  for (uint32_t seed = 0; seed < 120; ++seed) {
    const View view = randomView(seed);
    TerrainCache cache = makeRandomForest(seed, view);
    const Selection all = select(cache, view, CullingScheme::none);
    const Selection some = select(cache, view, CullingScheme::frustum, 20, horizon);
    const auto drawn = byKey(cache, some), full = byKey(cache, all);
    for (const auto& [key, draw] : drawn) REQUIRE(full.contains(key));
    for (const auto& [key, draw] : full) {
      if (drawn.contains(key)) continue;
      bool isOutside = true, isBelow = true;
      for (const Vec3d& vertex : makeForestChunk(key, false, true).verticesEcefM) {
        const bool vertexBelow = isBelowHorizon(view, vertex);
        REQUIRE((vertexBelow || outsideFrustumM(view, vertex) > 0));
        isBelow &= vertexBelow;
        isOutside &= outsideFrustumM(view, vertex) > 0;
      }
      outside += isOutside ? 1 : 0;
      below += isBelow ? 1 : 0;
    }
  }
  CHECK(outside > 1000);
  CHECK(below > 1000);
}

TEST_CASE("what is drawn is said to hide the sky below the horizon where it was asked, whatever is culled") {
  size_t hides = 0;
  for (uint32_t seed = 0; seed < 120; ++seed) {
    const View view = randomView(seed);
    TerrainCache cache = makeRandomForest(seed, view);
    const Selection some = select(cache, view, CullingScheme::frustum);
    CHECK(select(cache, view, CullingScheme::none).hidesBelowHorizon == some.hidesBelowHorizon);
    CHECK_FALSE(select(cache, view, CullingScheme::frustum, 20, HorizonTest::none).hidesBelowHorizon);
    hides += some.hidesBelowHorizon;
    if (!some.hidesBelowHorizon) continue;
    for (const DrawnChunk& draw : some.draws) {
      const ChunkMeta& meta = cache.node(draw.node).meta;
      const double reachM = std::sqrt(glm::dot(view.eyeEcefM, view.eyeEcefM) - std::pow(kSemiMinorM - 12000, 2));
      if (draw.distanceM < 0.99 * reachM) CHECK(meta.minHeightM - meta.geometricErrorM > -kDeepestGroundM);
    }
  }
  INFO(hides);
  CHECK(hides > 3);
  CHECK(hides < 110);
}

TEST_CASE("skirts hang where the neighbour is of another level and nowhere else, as deep as both errors") {
  size_t with = 0, without = 0;
  for (uint32_t seed = 0; seed < 40; ++seed) {
    const View view = randomView(seed);
    TerrainCache cache = makeRandomForest(seed, view);
    const Selection selection = select(cache, view, CullingScheme::none);
    const auto drawn = byKey(cache, selection);
    for (const DrawnChunk& draw : selection.draws) {
      const CacheNode& node = cache.node(draw.node);
      const TileKey key = node.meta.key;
      for (Side side : kSides) {
        bool differs = false;
        for (const EdgePoint& p : pointsAlong(key, side)) {
          const DrawnChunk* other = drawnAt(drawn, p.across.latDeg, p.across.lonDeg);
          REQUIRE(other != nullptr);
          const ChunkMeta& meta = cache.node(other->node).meta;
          if (meta.key.level() == key.level()) continue;
          differs = true;
          REQUIRE(draw.skirtDepthM[static_cast<size_t>(side)] >=
                  1.0999 * (node.meta.geometricErrorM + meta.geometricErrorM));
        }
        INFO(key.name() << " side " << static_cast<int>(side));
        const bool hasSkirt = (draw.skirtMask & (1u << static_cast<unsigned>(side))) != 0;
        if (differs) REQUIRE(hasSkirt);
        // At pole cells a coarser chunk that only touches the parent may add one.
        const bool besidePole =
            key.isPolar() || key.parent()->isPolar() || (key.level() > 1 && key.parent()->parent()->isPolar());
        if (!differs && !besidePole) REQUIRE_FALSE(hasSkirt);
        ++(hasSkirt ? with : without);
      }
    }
  }
  CHECK(with > 500);
  CHECK(without > 500);
}

TEST_CASE("what is culled changes no skirt beside what is drawn") {
  size_t compared = 0, halfSides = 0;
  for (uint32_t seed = 0; seed < 200; ++seed) {
    const View view = randomView(seed);
    TerrainCache cache = makeRandomForest(seed, view);
    const Selection whole = select(cache, view, CullingScheme::none);
    std::map<uint32_t, DrawnChunk> uncut;
    for (const DrawnChunk& draw : whole.draws) uncut[draw.node] = draw;
    const Selection culled = select(cache, view, CullingScheme::frustum);
    for (const DrawnChunk& draw : culled.draws) {
      for (Side side : kSides) {
        const auto s = static_cast<size_t>(side);
        size_t across = 0, left = 0;
        forEachAcross(cache, draw.node, side, [&](uint32_t other) {
          const Visit visit = cache.node(other).visit;
          ++across;
          left += visit == Visit::outsideFrustum || visit == Visit::belowHorizon;
        });
        if (left == across) continue;  // all of the edge is out of sight
        INFO("seed " << seed << ": " << cache.node(draw.node).meta.key.name() << " side " << s);
        REQUIRE((draw.skirtMask >> s & 1) == (uncut.at(draw.node).skirtMask >> s & 1));
        REQUIRE(draw.skirtDepthM[s] == uncut.at(draw.node).skirtDepthM[s]);
        ++compared;
        halfSides += across > 1;
      }
    }
  }
  CHECK(compared > 5000);
  CHECK(halfSides > 50);
}

TEST_CASE("a gap beside a chunk that is drawn too coarsely is never left out with its neighbour") {
  size_t pairs = 0;
  for (uint32_t seed = 0; seed < 200; ++seed) {
    const View view = randomView(seed);
    // Half of the children of levels 2 and 3 are missing, all others are there: chunks lie beside others that are up to
    // five levels finer.
    const Geodetic eye = geodeticFromEcef(view.eyeEcefM);
    TerrainCache cache = makeForest(around(eye.latDeg, eye.lonDeg, 3, kLevel), [seed](const TileKey& key) {
      const bool isLost = (key.level() == 2 || key.level() == 3) && std::mt19937_64(key.code() * 977 + seed)() % 2 == 0;
      return !isLost;
    });
    const Selection all = select(cache, view, CullingScheme::none, 2);
    const Selection some = select(cache, view, CullingScheme::frustum, 2);
    const auto drawn = byKey(cache, some), full = byKey(cache, all);
    for (const auto& [key, draw] : drawn) {
      for (Side side : kSides) {
        for (const EdgePoint& p : pointsAlong(key, side)) {
          const DrawnChunk* other = drawnAt(full, p.across.latDeg, p.across.lonDeg);
          const ChunkMeta& meta = cache.node(other->node).meta;
          if (drawn.contains(meta.key) || meta.key.level() == key.level()) continue;
          const double gapM = meta.geometricErrorM + forestErrorM(key.level());
          const Vec3d edgeM =
              ecefFromGeodetic({p.edge.latDeg, p.edge.lonDeg, forestHeightM(p.edge.latDeg, p.edge.lonDeg)});
          if (isBelowHorizon(view, edgeM)) continue;
          ++pairs;
          INFO("seed " << seed << ": " << key.name() << " beside " << meta.key.name());
          REQUIRE(outsideFrustumM(view, edgeM) > gapM);
        }
      }
    }
  }
  CHECK(pairs > 100);
}

}  // namespace eye
