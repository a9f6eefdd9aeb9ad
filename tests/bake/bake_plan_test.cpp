#include "bake/bake_plan.h"

#include <catch2/catch.hpp>

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

BakePlan planFor(const ElevationSurface& surface, std::optional<TileBounds> region = {}) {
  PlanOptions options;
  options.region = region;
  return makePlan(surface, nullptr, PatchOfPosts::kSpacingDeg, options);
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
      for (int level = 2; level < plans[i].meshLevel - 3; ++level) {
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

TEST_CASE("refinement beside fine data goes on across a pole") {
  const PatchOfPosts cap({89.9, 90, 10, 20});
  const BakePlan plan = planFor(cap);
  for (const double lonDeg : {15.0, 105.0, -165.0, -75.0}) CHECK(wants(plan, TileKey::containing(89.95, lonDeg, 8)));
  CHECK_FALSE(wants(plan, TileKey::containing(88, -165, 8)));
  CHECK_FALSE(wants(plan, TileKey::containing(-89.9, 15, 5)));
}

}  // namespace eye
