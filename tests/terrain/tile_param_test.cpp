#include <algorithm>
#include <cmath>
#include <random>

#include <catch2/catch.hpp>

#include "geo/frames.h"
#include "terrain/tile_key.h"

namespace eye {
namespace {

std::vector<TileKey> sampleCells() {
  std::vector<TileKey> cells;
  for (int octant = 0; octant < kOctants; ++octant) {
    for (const int level : {0, 1, 3, 7, 14, kMaxLevel}) {
      const uint32_t rows = uint32_t{1} << level;
      for (const uint32_t row : {0u, rows / 3, rows / 2, rows - 1 - (rows > 1 ? 1 : 0), rows - 1}) {
        const uint32_t columns = TileKey::fromGrid(level, octant, row, 0).columns();
        cells.push_back(TileKey::fromGrid(level, octant, row, columns - 1));
      }
    }
  }
  return cells;
}

TEST_CASE("corners of ordinary cells are exact") {
  for (const TileKey& key : sampleCells()) {
    if (key.isPolar()) continue;
    const TileBounds b = key.bounds();
    const LatLon southWest = latLonFromParam(key, {0, 0}), northEast = latLonFromParam(key, {1, 1});
    REQUIRE(southWest.latDeg == b.southDeg);
    REQUIRE(southWest.lonDeg == b.westDeg);
    REQUIRE(northEast.latDeg == b.northDeg);
    REQUIRE(northEast.lonDeg == b.eastDeg);
  }
}

TEST_CASE("the edges of pole cells are exact") {
  for (const TileKey& key : sampleCells()) {
    if (!key.isPolar()) continue;
    const TileBounds b = key.bounds();
    const double poleLat = key.isSouthern() ? -90.0 : 90.0;
    const double equatorwardLat = key.isSouthern() ? b.northDeg : b.southDeg;
    CHECK(latLonFromParam(key, {0, 0}).latDeg == poleLat);
    const LatLon sEnd = latLonFromParam(key, {1, 0}), tEnd = latLonFromParam(key, {0, 1});
    CHECK(sEnd.latDeg == equatorwardLat);
    CHECK(tEnd.latDeg == equatorwardLat);
    CHECK(sEnd.lonDeg == (key.isSouthern() ? b.eastDeg : b.westDeg));
    CHECK(tEnd.lonDeg == (key.isSouthern() ? b.westDeg : b.eastDeg));
    const TileParam west = paramFromLatLon(key, {poleLat / 2 + equatorwardLat / 2, b.westDeg});
    CHECK(std::min(west.s, west.t) == 0.0);
    CHECK(std::max(west.s, west.t) == 0.5);
  }
}

TEST_CASE("a point's parameters give the point back") {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  for (const TileKey& key : sampleCells()) {
    const double heightDeg = key.bounds().northDeg - key.bounds().southDeg;
    for (int i = 0; i < 100; ++i) {
      const TileParam p{unit(random), unit(random)};
      if (key.isPolar() && std::hypot(p.s, p.t) > 1) continue;
      const LatLon place = latLonFromParam(key, p);
      const TileBounds b = key.bounds();
      REQUIRE((place.latDeg >= b.southDeg && place.latDeg <= b.northDeg));
      REQUIRE((place.lonDeg >= b.westDeg && place.lonDeg <= b.eastDeg));
      // A whole turn more or less is the same place.
      for (const double turn : {0.0, 360.0, -360.0}) {
        const TileParam back = paramFromLatLon(key, {place.latDeg, place.lonDeg + turn});
        // Doubles of 540 degrees have steps of 1.1e-13 degrees.
        const double tolerance =
            1e-14 + 3e-13 / heightDeg * (key.isPolar() ? 1.0 : key.columns() / 90.0 * heightDeg + 1);
        REQUIRE(std::abs(back.s - p.s) <= tolerance);
        REQUIRE(std::abs(back.t - p.t) <= tolerance);
      }
    }
  }
}

TEST_CASE("parameters run counterclockwise seen from above in both hemispheres") {
  for (const TileKey& key : sampleCells()) {
    const double d = 1e-3;
    const TileParam centre{0.4, 0.4};
    const auto ecefAt = [&](double s, double t) {
      const LatLon p = latLonFromParam(key, {s, t});
      return ecefFromGeodetic({p.latDeg, p.lonDeg, 0});
    };
    const Vec3d origin = ecefAt(centre.s, centre.t);
    const Vec3d alongS = glm::normalize(ecefAt(centre.s + d, centre.t) - origin);
    const Vec3d alongT = glm::normalize(ecefAt(centre.s, centre.t + d) - origin);
    const LatLon place = latLonFromParam(key, centre);
    CAPTURE(key.name());
    REQUIRE(glm::dot(glm::cross(alongS, alongT), upAt(place.latDeg, place.lonDeg)) > 0.5);
  }
}

TEST_CASE("a pole cell's parameters are smooth at the pole") {
  // Points on a small circle about the pole map to a circle about (0, 0): no direction is stretched or missing.
  for (const int octant : {0, 1, 4, 7}) {
    const TileKey key = TileKey::fromGrid(5, octant, 31, 0);
    const TileBounds b = key.bounds();
    const double heightDeg = b.northDeg - b.southDeg;
    for (double a = 0; a <= 1; a += 0.125) {
      const double lat = (key.isSouthern() ? -1 : 1) * (90 - heightDeg * 1e-3);
      const TileParam p = paramFromLatLon(key, {lat, b.westDeg + a * (b.eastDeg - b.westDeg)});
      CHECK(std::hypot(p.s, p.t) == Approx(1e-3).epsilon(1e-9));
      CHECK((p.s >= 0 && p.t >= 0));
    }
  }
}

}  // namespace
}  // namespace eye
