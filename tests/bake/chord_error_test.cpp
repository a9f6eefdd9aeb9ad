// Chords against many exact points along them.
#include "bake/chord_error.h"

#include <algorithm>
#include <random>

#include <catch2/catch.hpp>

#include "bake/post_surface.h"

using namespace eye;
using namespace eye::test;

namespace {

double denseErrorM(const ElevationSurface& surface, const ChordEnd& a, const ChordEnd& b) {
  const Vec3d from = ecefFromGeodetic({a.latDeg, a.lonDeg, a.altM}),
              to = ecefFromGeodetic({b.latDeg, b.lonDeg, b.altM});
  constexpr int kPoints = 4000;
  double worst = 0;
  for (int i = 0; i <= kPoints; ++i) {
    const Geodetic g = geodeticFromEcef(from + (to - from) * (static_cast<double>(i) / kPoints));
    worst = std::max(worst, std::abs(surface.heightM(g.latDeg, g.lonDeg) - g.altM));
  }
  return worst;
}

// Random chords inside a region, of up to `reach` of its size.
void checkChords(const TileBounds& region, int postsPerDeg, double altSpreadM, double reach, double toleranceM) {
  const PostSurface surface(postsPerDeg, roughGlobeM);
  SampleGrid grid;
  fillGrid(surface, SampleBlock{region, 1.0 / postsPerDeg}, 1e9, grid);
  std::mt19937 random(9);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  const auto pick = [&](double low, double high) { return low + (high - low) * share(random); };
  for (int i = 0; i < 60; ++i) {
    const double south = pick(region.southDeg, region.northDeg), west = pick(region.westDeg, region.eastDeg);
    const double north = south + (pick(region.southDeg, region.northDeg) - south) * reach;
    const double east = west + (pick(region.westDeg, region.eastDeg) - west) * reach;
    const ChordEnd a{south, west, surface.heightM(south, west) + pick(-altSpreadM, altSpreadM)};
    const ChordEnd b{north, east, surface.heightM(north, east) + pick(-altSpreadM, altSpreadM)};
    ChordError found;
    findChordError(grid, a, b, toleranceM, found);
    const double dense = denseErrorM(surface, a, b);
    INFO("from " << a.latDeg << ' ' << a.lonDeg << " to " << b.latDeg << ' ' << b.lonDeg);
    CHECK(found.errorM >= dense - 0.02 * toleranceM);
    CHECK(found.errorM <= dense * 1.001 + 0.02 * toleranceM);
    CHECK(found.heightM == Approx(surface.heightM(found.place.latDeg, found.place.lonDeg)).margin(0.01 * toleranceM));
  }
}

}  // namespace

TEST_CASE("The worst point of a chord is found: short ones over real posts' spacing") {
  checkChords({47.25, 47.3, 11.0, 11.1}, 1200, 2.0, 0.2, 0.25);
}

TEST_CASE("The worst point of a chord is found: over ten posts, and long ones that bend") {
  checkChords({47.0, 48.0, 11.0, 12.0}, 40, 50.0, 0.5, 4.0);
  checkChords({30.0, 50.0, -40.0, -10.0}, 4, 100.0, 1.0, 400.0);
  checkChords({-60.0, -45.0, 100.0, 120.0}, 4, 100.0, 1.0, 400.0);
}

TEST_CASE("The worst point of a chord is found: beside a pole") {
  // North of the region lies more: keep chords, which bend polewards, inside.
  checkChords({88.0, 90.0, 0.0, 90.0}, 8, 20.0, 0.4, 8.0);
  checkChords({-90.0, -88.0, 0.0, 90.0}, 8, 20.0, 0.4, 8.0);
}

// The last row's chords were once cut into 16,384 pieces each, in the south alone: minutes for a tile.
TEST_CASE("A chord beside the south pole is no more work than beside the north pole") {
  const PostSurface surface(12, roughGlobeM);
  const auto cpuS = [&](double sign) {
    SampleGrid grid;
    const TileBounds cap = sign > 0 ? TileBounds{89.6, 90, 0, 90} : TileBounds{-90, -89.6, 0, 90};
    fillGrid(surface, SampleBlock{cap, 1.0 / 12}, 1e9, grid);
    const std::clock_t began = std::clock();
    for (int i = 0; i < 200; ++i) {
      ChordError found;
      findChordError(grid, {sign * 89.95, 0.4 * i, 2000}, {sign * 89.99, 0.4 * i + 5, 2000}, 25, found);
      CHECK(found.errorM > 0);
    }
    return static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC;
  };
  CHECK(cpuS(-1) < 20 * cpuS(1) + 0.01);
}

TEST_CASE("A chord's bend in longitude counts where the ground is steep") {
  // A wall that runs north and south beneath a diagonal chord of 36 km: it bends 40 m sideways.
  const PostSurface walls(1, [](double, double lonDeg) { return std::fmod(std::abs(lonDeg), 2.0) * 100'000.0; });
  SampleGrid grid;
  fillGrid(walls, SampleBlock{{40, 42, 10, 12}, 1.0}, 1e9, grid);
  const ChordEnd a{40.1, 10.1, walls.heightM(40.1, 10.1)}, b{40.4, 10.4, walls.heightM(40.4, 10.4)};
  ChordError found;
  findChordError(grid, a, b, 100.0, found);
  CHECK(found.errorM == Approx(denseErrorM(walls, a, b)).margin(1.0));
}

TEST_CASE("A chord outside the grid changes nothing") {
  const PostSurface surface(40, roughGlobeM);
  SampleGrid grid;
  fillGrid(surface, SampleBlock{{10, 11, 20, 21}, 1.0 / 40}, 1e9, grid);
  ChordError worst{1.5, {1, 2}, 3};
  findChordError(grid, {12, 20, 9000}, {12.1, 20.5, 9000}, 1.0, worst);
  findChordError(grid, {10.5, 22, 9000}, {10.6, 22.5, 9000}, 1.0, worst);
  CHECK(worst.errorM == 1.5);
}
