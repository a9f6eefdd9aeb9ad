// Clusters of baked tiles: bounds and cones against brute force on made and real ground.
#include <random>

#include <catch2/catch.hpp>

#include "bake/elevation_mosaic.h"
#include "bake/mesher.h"
#include "bake/post_surface.h"
#include "support/cluster_checks.h"
#include "support/places.h"

using namespace eye;
using namespace eye::test;

namespace {

void checkTile(const MeshedTile& tile, std::mt19937& random, ConeTally& tally) {
  const MeshPlace place = placeOf(tile.meta);
  requireBoundsHold(tile.mesh, place);
  tryEyes(tile.mesh, place, 40, random, tally);
  // Interior vertices in the order of their first use: what lies together is drawn together.
  size_t loop = 0;
  for (const uint16_t count : tile.mesh.boundary) loop += count;
  size_t seen = loop;
  for (const uint16_t index : tile.mesh.indices) {
    REQUIRE(index <= seen);
    if (index == seen) ++seen;
  }
  CHECK(seen == tile.mesh.vertices.size());
}

}  // namespace

TEST_CASE("Clusters of a rough globe's tiles hold what they say, at poles and date line too") {
  const PostSurface globe(8, roughGlobeM);
  std::mt19937 random(11);
  ConeTally tally;
  for (const int level : {0, 3, 6}) {
    for (const LatLon& p : {LatLon{89.99, 100}, {-40, 179.99}, {20, -179.99}, {-89.9, -100}, {0.1, 0.1}}) {
      checkTile(meshTile(globe, TileKey::containing(p.latDeg, p.lonDeg, level), std::ldexp(4000.0, -level)), random,
                tally);
    }
  }
  CHECK(tally.tried > 5000);
  CHECK(tally.wrong == 0);
  CHECK(tally.wrongInFloats == 0);
}

TEST_CASE("Clusters of real mountains hold what they say") {
  const std::string file = eye::test::kTestData + "/dem/carpathia/N49E020.hgt";
  const auto tatras = ElevationMosaic::open({file});
  if (!tatras) {
    WARN("no dem/carpathia/N49E020.hgt under " << eye::test::kTestData << ": not tested");
    return;
  }
  std::mt19937 random(12);
  ConeTally tally;
  for (const int level : {9, 11, 13}) {
    const MeshedTile tile = meshTile(**tatras, TileKey::containing(49.18, 20.1, level), std::ldexp(2.0, 13 - level));
    CHECK(tile.mesh.clusters.size() >= tile.mesh.indices.size() / 3 / 64);
    checkTile(tile, random, tally);
  }
  INFO(tally.tried << " cases, " << tally.away << " said to face away, " << tally.allAway << " do");
  CHECK(tally.wrong == 0);
  CHECK(tally.wrongInFloats == 0);
  CHECK(tally.away > tally.allAway / 4);
}
