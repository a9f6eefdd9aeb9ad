// Clusters' bounds against brute force: nothing sticks out, nothing that faces the eye is ever said to face away.
#include "terrain/clusters.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <catch2/catch.hpp>

#include "support/cluster_checks.h"
#include "synthetic_chunk.h"
#include "terrain/chunk_verify.h"

namespace eye {
namespace {

struct MadeMesh {
  ChunkMesh mesh;
  MeshPlace place;
};

double uniform(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

// Anywhere on Earth, with a box about it: `boxAxes` turned at random, or east, north and up.
MeshPlace placeFor(const ChunkMesh& mesh, double stepM, std::mt19937& random) {
  MeshPlace place;
  place.stepM = stepM;
  const double lat = uniform(random, -90, 90), lon = uniform(random, -180, 180);
  place.originLattice = latticeFromEcef(ecefFromGeodetic({lat, lon, uniform(random, -400, 8000)}), stepM);
  const Mat3d axes = ecefFromEnu(lat, lon) * (random() % 2 == 0 ? ecefFromEnu(lon / 2, lat) : Mat3d(1.0));
  Vec3d low(1e12), high(-1e12);
  for (const ChunkVertex& v : mesh.vertices) {
    const Vec3d along = (Vec3d(v.x, v.y, v.z) * stepM) * axes;
    low = glm::min(low, along);
    high = glm::max(high, along);
  }
  place.box.centreEcefM = ecefFromLattice(place.originLattice, stepM) + axes * ((low + high) / 2.0);
  for (int a = 0; a < 3; ++a)
    place.box.halfAxesEcefM[static_cast<size_t>(a)] = axes[a] * ((high - low)[a] / 2.0 + 1e-3);
  return place;
}

// Triangles that have nothing to do with one another, of all sizes, some without area.
MadeMesh soup(int triangles, std::mt19937& random) {
  MadeMesh made;
  const int reach = 1 << (2 + random() % 14);
  const auto number = [&] {
    return static_cast<int16_t>(static_cast<int>(random() % (2u * static_cast<unsigned>(reach))) - reach);
  };
  for (int i = 0; i < std::max(3, triangles / 2); ++i)
    made.mesh.vertices.push_back({number(), number(), number(), 0, 0, 0, 0, 0});
  for (int i = 0; i < 3 * triangles; ++i)
    made.mesh.indices.push_back(static_cast<uint16_t>(random() % made.mesh.vertices.size()));
  made.place = placeFor(made.mesh, std::ldexp(1.0, static_cast<int>(random() % 12) - 6), random);
  return made;
}

// A rough sheet: steps of `roughness` lattice steps on a grid, turned anyhow. The rougher, the wider its cones.
MadeMesh sheet(int edges, double roughness, std::mt19937& random) {
  MadeMesh made;
  const Mat3d turn = ecefFromEnu(uniform(random, -90, 90), uniform(random, -180, 180));
  const double spacing = 20000.0 / edges;
  const Vec3d slope(uniform(random, -1, 1), uniform(random, -1, 1), 0);
  for (int j = 0; j <= edges; ++j) {
    for (int i = 0; i <= edges; ++i) {
      const double x = (i - edges / 2.0) * spacing, y = (j - edges / 2.0) * spacing;
      const double z = slope.x * x / 2 + slope.y * y / 2 + roughness * uniform(random, -1, 1);
      const Vec3d p = glm::clamp(glm::round(turn * Vec3d(x, y, z)), -32767.0, 32767.0);
      made.mesh.vertices.push_back(
          {static_cast<int16_t>(p.x), static_cast<int16_t>(p.y), static_cast<int16_t>(p.z), 0, 0, 0, 0, 0});
    }
  }
  for (int j = 0; j < edges; ++j) {
    for (int i = 0; i < edges; ++i) {
      const auto a = static_cast<uint16_t>(j * (edges + 1) + i), b = static_cast<uint16_t>(a + 1);
      const auto d = static_cast<uint16_t>(a + edges + 1), c = static_cast<uint16_t>(d + 1);
      made.mesh.indices.insert(made.mesh.indices.end(), {a, b, c, a, c, d});
    }
  }
  made.place = placeFor(made.mesh, 0.25, random);
  return made;
}

// Parallel triangles above one another, a tower of floors: the planes lie as far from the middle as its corners do.
MadeMesh tower(int floors, std::mt19937& random) {
  MadeMesh made;
  const Mat3d turn = ecefFromEnu(uniform(random, -90, 90), uniform(random, -180, 180));
  for (int i = 0; i < floors; ++i) {
    const double z = uniform(random, -15000, 15000);
    for (const Vec3d& corner : {Vec3d(-900, -900, z), Vec3d(900, -900, z), Vec3d(0, 900, z)}) {
      const Vec3d p = glm::round(turn * corner);
      made.mesh.indices.push_back(static_cast<uint16_t>(made.mesh.vertices.size()));
      made.mesh.vertices.push_back(
          {static_cast<int16_t>(p.x), static_cast<int16_t>(p.y), static_cast<int16_t>(p.z), 0, 0, 0, 0, 0});
    }
  }
  made.place = placeFor(made.mesh, 0.25, random);
  made.place.box.halfAxesEcefM = {turn[0] * 250.0, turn[1] * 250.0, turn[2] * 4000.0};
  made.place.box.centreEcefM = ecefFromLattice(made.place.originLattice, 0.25);
  return made;
}

std::vector<std::array<uint16_t, 3>> sortedTriangles(const ChunkMesh& mesh) {
  std::vector<std::array<uint16_t, 3>> all;
  for (size_t i = 0; i < mesh.indices.size(); i += 3) {
    std::array<uint16_t, 3> t{mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]};
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    all.push_back(t);
  }
  std::ranges::sort(all);
  return all;
}

}  // namespace

TEST_CASE("Clusters hold all triangles, each once, and their bounds hold them to the last bit") {
  std::mt19937 random(1);
  for (int round = 0; round < 300; ++round) {
    const int triangles = 1 + static_cast<int>(random() % (round % 10 == 0 ? 3000 : 200));
    MadeMesh made = round % 2 == 0 ? soup(triangles, random) : sheet(1 + round % 25, round * 3.0, random);
    const auto before = sortedTriangles(made.mesh);
    const std::vector<ChunkVertex> vertices = made.mesh.vertices;
    ChunkMesh twin = made.mesh;
    buildClusters(made.place, twin);
    buildClusters(made.place, made.mesh);
    REQUIRE((made.mesh.indices == twin.indices && made.mesh.clusters == twin.clusters));
    REQUIRE(sortedTriangles(made.mesh) == before);
    REQUIRE(made.mesh.vertices == vertices);
    test::requireBoundsHold(made.mesh, made.place);
    if (before.size() <= 64) REQUIRE(made.mesh.clusters.size() == 1);
    REQUIRE(made.mesh.clusters.size() <= before.size() / 32 + 1);  // none much smaller than it must be
  }
  ChunkMesh empty;
  buildClusters({}, empty);
  CHECK(empty.clusters.empty());
}

TEST_CASE("A chunk on any tile has sound clusters") {
  for (const TileKey& key : {TileKey::octantRoot(3), TileKey::fromGrid(7, 0, 12, 3), TileKey::fromGrid(5, 1, 31, 0),
                             TileKey::fromGrid(5, 6, 31, 0), TileKey::containing(49, 20, 14)}) {
    const SyntheticMesh made = syntheticMesh(key, 40);
    test::requireBoundsHold(made.mesh, placeOf(made.meta));
  }
}

TEST_CASE("A box without extent along an axis holds what lies in it") {
  MadeMesh made;
  made.mesh.vertices = {{0, 0, 0, 0, 0, 0, 0, 0}, {100, 0, 0, 0, 0, 0, 0, 0}, {0, 100, 0, 0, 0, 0, 0, 0}};
  made.mesh.indices = {0, 1, 2};
  made.place.box.halfAxesEcefM = {Vec3d(100, 0, 0), Vec3d(0, 100, 0), Vec3d(0, 0, 0)};
  buildClusters(made.place, made.mesh);
  REQUIRE(made.mesh.clusters.size() == 1);
  CHECK(made.mesh.clusters[0].boxMin[2] <= made.mesh.clusters[0].boxMax[2]);
  test::requireBoundsHold(made.mesh, made.place);
}

TEST_CASE("A cluster that is said to face away has no triangle that faces the eye") {
  std::mt19937 random(2);
  test::ConeTally tally;
  for (int round = 0; round < 150; ++round) {
    MadeMesh made = round % 5 == 0   ? soup(40, random)
                    : round % 5 == 1 ? tower(30, random)
                                     : sheet(1 + round % 20, round * round * 0.1, random);
    buildClusters(made.place, made.mesh);
    test::tryEyes(made.mesh, made.place, 400, random, tally);
  }
  INFO(tally.tried << " cases, " << tally.away << " said to face away, " << tally.allAway << " do");
  CHECK(tally.tried > 100'000);
  CHECK(tally.wrong == 0);
  CHECK(tally.wrongInFloats == 0);
  CHECK(5 * tally.away > 2 * tally.allAway);  // the test is no mere refusal
}

TEST_CASE("Cones are as narrow as their triangles let them be") {
  // A flat sheet: seen from below its plane by more than what rounding adds, it faces away.
  std::mt19937 random(3);
  for (int round = 0; round < 100; ++round) {
    MadeMesh made = sheet(4, 0.0, random);
    buildClusters(made.place, made.mesh);
    REQUIRE(made.mesh.clusters.size() == 1);
    CHECK(made.mesh.clusters[0].coneCutoff <= 4);  // 1.8 degrees
  }
}

TEST_CASE("A database whose clusters hold too little is found out") {
  const TileKey key = TileKey::fromGrid(7, 0, 12, 3);
  SyntheticMesh made = syntheticMesh(key, 20);
  made.meta.hasImagery = false;
  const auto verdict = [&](const ChunkMesh& mesh) { return checkContents({made.meta, encodeMesh(mesh), {}}, 16); };
  REQUIRE(verdict(made.mesh));
  ChunkMesh bad = made.mesh;
  ++bad.clusters[3].boxMin[0];
  ++bad.clusters[3].boxMin[0];
  REQUIRE_FALSE(verdict(bad));
  CHECK_THAT(verdict(bad).error().message, Catch::Contains("outside its cluster's box"));
  bad = made.mesh;
  REQUIRE(bad.clusters[2].coneCutoff > 2);
  REQUIRE(bad.clusters[2].coneCutoff < 127);
  bad.clusters[2].coneCutoff = static_cast<int8_t>(bad.clusters[2].coneCutoff - 3);
  REQUIRE_FALSE(verdict(bad));
  CHECK_THAT(verdict(bad).error().message, Catch::Contains("outside its cluster's cone"));
}

}  // namespace eye
