#include "paging/horizon.h"

#include <catch2/catch.hpp>
#include <random>

#include "paging/lod_select.h"
#include "paging/synthetic_forest.h"

namespace eye {
namespace {

const Vec3d kAxesM(kSemiMajorM, kSemiMajorM, kSemiMinorM);

// Whether the segment enters the ellipsoid lowered by a depth, by looking for its lowest point.
bool isHiddenByBruteForce(const Vec3d& eyeM, const Vec3d& pointM, double depthM) {
  double low = 0, high = 1;
  const auto heightM = [&](double t) { return geodeticFromEcef(glm::mix(eyeM, pointM, t)).altM; };
  for (int i = 0; i < 100; ++i) {  // the height along a straight line has one minimum
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    (heightM(a) < heightM(b) ? high : low) = heightM(a) < heightM(b) ? b : a;
  }
  return heightM(low) < -depthM;
}

}  // namespace

TEST_CASE("a point is below the horizon exactly when the ellipsoid is in the way") {
  std::mt19937 random(3);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<>(a, b)(random); };
  int hidden = 0, seen = 0;
  for (int i = 0; i < 4000; ++i) {
    const Geodetic eye{uniform(-90, 90), uniform(-180, 180), std::pow(10.0, uniform(0.5, 7))};
    const double farDeg = std::pow(10.0, uniform(-2, 2));
    Geodetic point{eye.latDeg + uniform(-farDeg, farDeg), eye.lonDeg + uniform(-farDeg, farDeg), uniform(1, 9000)};
    if (std::abs(point.latDeg) > 90) continue;
    point.lonDeg = std::remainder(point.lonDeg, 360.0);
    const Vec3d eyeM = ecefFromGeodetic(eye), pointM = ecefFromGeodetic(point);
    const bool isHidden = belowHorizon(eyeM / kAxesM, pointM / kAxesM);
    // Within a metre of grazing, the brute force is not sharp enough to tell.
    if (isHidden) CHECK(isHiddenByBruteForce(eyeM, pointM, -1));
    if (!isHidden) CHECK_FALSE(isHiddenByBruteForce(eyeM, pointM, 1));
    ++(isHidden ? hidden : seen);
  }
  CHECK(hidden > 500);
  CHECK(seen > 500);
}

TEST_CASE("under the ellipsoid nothing is hidden") {
  const Vec3d eyeM = ecefFromGeodetic({31.5, 35.4, -400});
  CHECK_FALSE(belowHorizon(eyeM / kAxesM, Vec3d(-1.1, 0, 0)));
  const ForestChunk far = makeForestChunk(TileKey::containing(-31, -145, 4), false, true);
  CHECK_FALSE(Horizon(eyeM, 0).hides(far.meta));
  CHECK(Horizon(eyeM, 450).hides(far.meta));
}

TEST_CASE("an eye under the ellipsoid has a horizon when it is above what is drawn") {
  const ForestChunk far = makeForestChunk(TileKey::containing(-31, -145, 4), false, true);
  for (const double altM : {-1.0, -400.0, -430.0}) {
    const Horizon horizon = horizonForTolerance(ecefFromGeodetic({31.5, 35.4, altM}), 80e3, 1e-3);
    CHECK(horizon.depthM() > -altM);
    CHECK(horizon.hides(far.meta));
    CHECK(horizon.hides(far.meta, HorizonTest::paper));
  }
}

TEST_CASE("what the horizon hides is behind the lowered ellipsoid, with all that descends from it") {
  int hidden = 0;
  for (uint32_t seed = 0; seed < 600; ++seed) {
    const View view = randomView(seed);
    std::mt19937 random(seed);
    const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<>(a, b)(random); };
    const double depthM = seed % 2 == 0 ? 0 : std::pow(10.0, uniform(0, 4));
    const int level = 3 + static_cast<int>(seed % 8);
    const Geodetic eye = geodeticFromEcef(view.eyeEcefM);
    const double farDeg = std::pow(10.0, uniform(-0.5, 1.9));
    const double latDeg = std::clamp(eye.latDeg + uniform(-farDeg, farDeg), -90.0, 90.0);
    const double lonDeg = std::remainder(eye.lonDeg + uniform(-farDeg, farDeg), 360.0);
    const ForestChunk chunk = makeForestChunk(TileKey::containing(latDeg, lonDeg, level), true, true);
    if (!Horizon(view.eyeEcefM, depthM).hides(chunk.meta)) continue;
    ++hidden;
    for (const Vec3d& vertex : chunk.verticesEcefM) {
      Geodetic raised = geodeticFromEcef(vertex);
      raised.altM += 2 * chunk.meta.geometricErrorM;
      REQUIRE(isHiddenByBruteForce(view.eyeEcefM, ecefFromGeodetic(raised), depthM));
    }
  }
  CHECK(hidden > 80);
}

}  // namespace eye
