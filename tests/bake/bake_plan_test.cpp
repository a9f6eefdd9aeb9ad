#include "bake/bake_plan.h"

#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "bake/post_surface.h"

namespace eye {
namespace {

// Posts in one region and nowhere else.
class PatchOfPosts final : public ElevationSurface {
 public:
  explicit PatchOfPosts(const TileBounds& patch) : patch_(patch) {}
  double heightM(double, double) const override { return 0; }
  PostLines postLines(const TileBounds&) const override { return {}; }
  double finestSpacingDeg(const TileBounds& r) const override {
    const bool meets = r.southDeg < patch_.northDeg && patch_.southDeg < r.northDeg && r.westDeg < patch_.eastDeg &&
                       patch_.westDeg < r.eastDeg;
    return meets ? kSpacingDeg : 0;
  }
  TileBounds dataBounds() const override { return patch_; }

  static constexpr double kSpacingDeg = 1.0 / 1200;

 private:
  TileBounds patch_;
};

// A globe of 5 minutes with a patch of 3 seconds over it.
class PatchOverGlobe final : public ElevationSurface {
 public:
  double heightM(double, double) const override { return 0; }
  PostLines postLines(const TileBounds&) const override { return {}; }
  double finestSpacingDeg(const TileBounds& r) const override { return std::ranges::min(spacingsDeg(r)); }
  std::vector<double> spacingsDeg(const TileBounds& r) const override {
    const bool meets = r.southDeg < 50 && 47 < r.northDeg && r.westDeg < kEastDeg && 18 < r.eastDeg;
    if (!meets) return {kGlobeDeg};
    const bool covers = r.southDeg >= 47 && r.northDeg <= 50 && r.westDeg >= 18 && r.eastDeg <= kEastDeg;
    return covers ? std::vector{kPatchDeg} : std::vector{kPatchDeg, kGlobeDeg};
  }
  TileBounds dataBounds() const override { return {-90, 90, -180, 180}; }

  static constexpr double kPatchDeg = 1.0 / 1200, kGlobeDeg = 1.0 / 12;
  // Tiles of level 9 lie inside of it whose parents, as exact as the globe, do not.
  static constexpr double kEastDeg = 22.2;
};

BakePlan planFor(const ElevationSurface& surface, std::optional<TileBounds> region = {}) {
  PlanOptions options;
  options.region = region;
  return makePlan(surface, nullptr, {PatchOfPosts::kSpacingDeg}, options);
}

bool wants(const BakePlan& plan, const TileKey& key) {
  return plan.wantsChildren(key, 1e6);
}

}  // namespace

// The grid turned by half a circle is itself: what is refined about the date line must be what is refined about the
// prime meridian.
TEST_CASE("refinement beside fine data goes on across the date line") {
  const bool isWestOfIt = GENERATE(true, false);
  for (const double latDeg : {0.3, 48.5, -66.2, 88.0}) {
    const double lonDeg = isWestOfIt ? 179 : -180;
    const double turnedLonDeg = isWestOfIt ? -1 : 0;
    const TileBounds atDateLine{latDeg, latDeg + 1, lonDeg, lonDeg + 1};
    const TileBounds atGreenwich{latDeg, latDeg + 1, turnedLonDeg, turnedLonDeg + 1};
    const TileBounds everywhere{-90, 90, -180, 180};
    const PatchOfPosts patch(atDateLine), turned(atGreenwich), globe(everywhere);
    const BakePlan plans[] = {planFor(patch), planFor(globe, atDateLine)};
    const BakePlan turnedPlans[] = {planFor(turned), planFor(globe, atGreenwich)};
    for (size_t i = 0; i < 2; ++i) {
      int wanted = 0, beyond = 0;
      for (int level = 2; level < plans[i].finest().meshLevel - 3; ++level) {
        const double cellDeg = 90 / std::exp2(level);
        for (double lat = latDeg + 0.5 - 3 * cellDeg; lat < latDeg + 0.5 + 3 * cellDeg; lat += cellDeg / 2) {
          if (std::abs(lat) >= 90) continue;
          for (double lon = -6 * cellDeg; lon < 6 * cellDeg; lon += cellDeg / 2) {
            const TileKey key = TileKey::containing(lat, std::remainder(lon + 180 - 0.01 * cellDeg, 360), level);
            const TileKey turnedKey = TileKey::containing(lat, std::remainder(lon - 0.01 * cellDeg, 360), level);
            INFO("plan " << i << ": " << key.name() << " like " << turnedKey.name());
            REQUIRE(wants(plans[i], key) == wants(turnedPlans[i], turnedKey));
            wanted += wants(plans[i], key);
            beyond += wants(plans[i], key) && (key.bounds().eastDeg < 0) == isWestOfIt;
          }
        }
      }
      CHECK(wanted > beyond);
      CHECK(beyond > 20);
    }
  }
}

// What a globe is baked to does not hang on what lies elsewhere over it.
TEST_CASE("each source keeps its own accuracy beside a finer one") {
  const PatchOverGlobe both;
  const BakePlan plan = makePlan(both, nullptr, {PatchOverGlobe::kPatchDeg, PatchOverGlobe::kGlobeDeg}, {});
  const test::PostSurface globe(12, [](double, double) { return 0.0; });
  const PatchOfPosts patch({47, 50, 18, PatchOverGlobe::kEastDeg});
  const BakePlan globeAlone = makePlan(globe, nullptr, {PatchOverGlobe::kGlobeDeg}, {}), patchAlone = planFor(patch);
  CHECK(plan.maxLevel == 14);
  CHECK(globeAlone.maxLevel == 8);
  for (int level = 0; level <= 8; ++level) {
    const TileKey key = TileKey::containing(-33, 60, level);
    INFO(key.name());
    CHECK(plan.toleranceM(key) == globeAlone.toleranceM(key));
    for (const double errorM : {1.0, 24.9, 25.1, 1e6})
      CHECK(plan.wantsChildren(key, errorM) == globeAlone.wantsChildren(key, errorM));
  }
  CHECK(plan.toleranceM(TileKey::containing(-33, 60, 8)) == Approx(25));
  for (int level = 8; level <= 14; ++level) {
    const TileKey key = TileKey::containing(48.5, 20.1, level);
    INFO(key.name());
    CHECK(plan.toleranceM(key) == patchAlone.toleranceM(key));
  }
  // The selection takes a chunk's descendants to lie within twice its own error.
  for (double lat = 46.03; lat < 51; lat += 0.07) {
    for (double lon = 17.03; lon < 23; lon += 0.07) {
      for (int level = 14; level > 0; --level) {
        const TileKey key = TileKey::containing(lat, lon, level);
        REQUIRE(plan.toleranceM(key) <= plan.toleranceM(*key.parent()));
      }
    }
  }

  PlanOptions options;
  options.errorM = 2;
  const BakePlan given = makePlan(both, nullptr, {PatchOverGlobe::kPatchDeg, PatchOverGlobe::kGlobeDeg}, options);
  CHECK(given.toleranceM(TileKey::containing(48.5, 20.1, 14)) == 2);
  CHECK(given.toleranceM(TileKey::containing(-33, 60, 8)) == Approx(25));
}

TEST_CASE("refinement beside fine data goes on across a pole") {
  const PatchOfPosts cap({89.9, 90, 10, 20});
  const BakePlan plan = planFor(cap);
  for (const double lonDeg : {15.0, 105.0, -165.0, -75.0}) CHECK(wants(plan, TileKey::containing(89.95, lonDeg, 8)));
  CHECK_FALSE(wants(plan, TileKey::containing(88, -165, 8)));
  CHECK_FALSE(wants(plan, TileKey::containing(-89.9, 15, 5)));
}

}  // namespace eye
