// Meshed tiles against a second opinion: error, cover, winding, and edges shared between neighbours.
#include "bake/mesher.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <random>

#include <catch2/catch.hpp>

#include "bake/mesh_probe.h"
#include "bake/post_surface.h"
#include "support/places.h"

using namespace eye;
using namespace eye::test;

namespace {

// Every post line crossing, every cell's centre and random points of every cell, thinned to about `maxProbes`; the
// greatest distance seen. Points that only straight edges' bulges keep from the mesh belong to a neighbour.
struct Measured {
  double errorM = 0;
  size_t probes = 0, missed = 0, torn = 0;
};
Measured measure(const ElevationSurface& surface, const MeshedTile& tile, double toleranceM, size_t maxProbes) {
  const TileBounds b = tile.meta.key.bounds();
  PostLines lines = surface.postLines(b);
  for (int i = 0; i <= 16; ++i) {
    if (lines.latDeg.size() < 16) lines.latDeg.push_back(b.southDeg + (b.northDeg - b.southDeg) * i / 16.0);
    if (lines.lonDeg.size() < 16) lines.lonDeg.push_back(b.westDeg + (b.eastDeg - b.westDeg) * i / 16.0);
  }
  std::sort(lines.latDeg.begin(), lines.latDeg.end());
  std::sort(lines.lonDeg.begin(), lines.lonDeg.end());
  const double edgeDeg = degFromRad((0.3 * toleranceM + 3.0 * tile.meta.stepM()) / kSemiMinorM);

  const MeshProbe probe(tile);
  Measured result;
  const auto look = [&](double lat, double lon) {
    const std::optional<ProbeHit> hit = probe.probe(lat, lon, surface.heightM(lat, lon));
    ++result.probes;
    if (!hit) {
      const double eastDeg = edgeDeg / std::max(std::cos(radFromDeg(lat)), 1e-3);
      result.missed += lat > b.southDeg + edgeDeg && lat < b.northDeg - edgeDeg && lon > b.westDeg + eastDeg &&
                       lon < b.eastDeg - eastDeg;
      return;
    }
    result.torn += hit->spreadM > 1e-3 * toleranceM;
    result.errorM = std::max(result.errorM, std::abs(hit->distanceM));
  };
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  const size_t cells = lines.latDeg.size() * lines.lonDeg.size();
  const double keep = static_cast<double>(maxProbes) / (12.0 * static_cast<double>(cells));
  for (size_t r = 0; r + 1 < lines.latDeg.size(); ++r) {
    for (size_t c = 0; c + 1 < lines.lonDeg.size(); ++c) {
      if (share(random) > keep) continue;
      const double south = lines.latDeg[r], west = lines.lonDeg[c];
      const double height = lines.latDeg[r + 1] - south, width = lines.lonDeg[c + 1] - west;
      look(south, west);
      look(south + height / 2, west + width / 2);
      for (int i = 0; i < 10; ++i) look(south + height * share(random), west + width * share(random));
    }
  }
  return result;
}

void checkGuarantee(const ElevationSurface& surface, const TileKey& key, double toleranceM, size_t maxProbes = 40000) {
  INFO(key.name() << " tolerance " << toleranceM);
  const MeshedTile tile = meshTile(surface, key, toleranceM);
  CHECK(tile.meta.geometricErrorM <= toleranceM);
  CHECK(tile.meta.latticeShift == 0);
  const Measured measured = measure(surface, tile, toleranceM, maxProbes);
  INFO("triangles " << tile.mesh.indices.size() / 3 << " probes " << measured.probes);
  CHECK(measured.probes > 100);
  CHECK(measured.errorM <= tile.meta.geometricErrorM + 1e-6);
  CHECK(measured.missed == 0);
  CHECK(measured.torn == 0);
}

// Directed edges: interior ones both ways, the boundary loop's once; every triangle counterclockwise from above.
void checkTopology(const MeshedTile& tile) {
  INFO(tile.meta.key.name());
  const std::vector<Vec3d> positions = positionsOf(tile);
  const std::vector<uint16_t>& indices = tile.mesh.indices;
  std::map<std::pair<int, int>, int> edges;
  size_t turnedOver = 0;
  for (size_t i = 0; i < indices.size(); i += 3) {
    const Vec3d a = positions[indices[i]], b = positions[indices[i + 1]], c = positions[indices[i + 2]];
    turnedOver += glm::dot(glm::cross(b - a, c - a), a) <= 0.0;
    for (size_t k = 0; k < 3; ++k) ++edges[{indices[i + k], indices[i + (k + 1) % 3]}];
  }
  CHECK(turnedOver == 0);
  int loop = 0;
  for (const uint16_t count : tile.mesh.boundary) loop += count;
  int unpaired = 0, wrong = 0;
  for (const auto& [edge, count] : edges) {
    wrong += count != 1;
    if (edges.count({edge.second, edge.first}) != 0) continue;
    ++unpaired;
    wrong += edge.first >= loop || edge.second != (edge.first + 1) % loop;
  }
  CHECK(wrong == 0);
  CHECK(unpaired == loop);
}

struct SidePoint {
  LatticePoint lattice;
  int16_t normalU, normalV;
  bool operator==(const SidePoint&) const = default;
};

// A side's points west to east or south to north.
std::vector<SidePoint> sidePoints(const MeshedTile& tile, Side side) {
  const std::vector<LatticePoint> lattice = latticeOf(tile);
  size_t begin = 0, loop = 0;
  for (const uint16_t count : tile.mesh.boundary) loop += count;
  std::vector<SidePoint> points;
  for (size_t i = 0; i < 4; ++i) {
    const size_t count = tile.mesh.boundary[i];
    if (kSides[i] == side && count > 0) {
      for (size_t k = begin; k <= begin + count; ++k) {
        const ChunkVertex& v = tile.mesh.vertices[k % loop];
        points.push_back({lattice[k % loop], v.normalU, v.normalV});
      }
    }
    begin += count;
  }
  if (side == Side::north || side == Side::west) std::reverse(points.begin(), points.end());
  return points;
}

Side opposite(Side side) {
  return static_cast<Side>((static_cast<int>(side) + 2) % 4);
}

// Compares all four sides of a tile with its neighbours'; the number of points that were compared.
size_t checkSides(const ElevationSurface& surface, const TileKey& key, const TileTolerance& toleranceM) {
  const MeshedTile tile = meshTile(surface, key, toleranceM);
  size_t compared = 0;
  for (const Side side : kSides) {
    const TileList<2> neighbours = key.neighbours(side);
    if (neighbours.count == 0) continue;
    INFO(key.name() << " side " << static_cast<int>(side));
    const std::vector<SidePoint> own = sidePoints(tile, side);
    std::vector<SidePoint> theirs;
    for (const TileKey& neighbour : neighbours) {
      // Across the equator south meets north; elsewhere too sides keep their geographic names.
      const std::vector<SidePoint> part = sidePoints(meshTile(surface, neighbour, toleranceM), opposite(side));
      theirs.insert(theirs.end(), part.begin() + (theirs.empty() ? 0 : 1), part.end());
    }
    REQUIRE(own.size() >= 2);
    // A wider neighbour's side has more: ours is part of it.
    CHECK(std::search(theirs.begin(), theirs.end(), own.begin(), own.end()) != theirs.end());
    const bool isWider = neighbours.count == 1 && neighbours.items[0].columns() < key.columns();
    if (!isWider) CHECK(own.size() == theirs.size());
    compared += own.size();
  }
  return compared;
}

size_t checkSides(const ElevationSurface& surface, const TileKey& key, double toleranceM) {
  return checkSides(surface, key, [=](const TileKey&) { return toleranceM; });
}

double toleranceOf(int level) {
  return std::ldexp(0.25, 14 - level);
}

// One degree of real posts, extended beyond its borders by its outermost posts; voids take their neighbour's height.
std::optional<PostSurface> readDegree(const std::string& name, int southDeg, int westDeg) {
  constexpr int kSide = 1201;
  std::ifstream file(eye::test::kTestData + "/dem/" + name, std::ios::binary);
  std::vector<char> bytes(size_t{kSide} * kSide * 2);
  if (!file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) return std::nullopt;
  auto posts = std::make_shared<std::vector<double>>();
  for (size_t i = 0; i < bytes.size(); i += 2) {
    const int value = static_cast<int16_t>(static_cast<uint8_t>(bytes[i]) << 8 | static_cast<uint8_t>(bytes[i + 1]));
    posts->push_back(value < -1000 && !posts->empty() ? posts->back() : value);
  }
  return PostSurface(kSide - 1, [=](double latDeg, double lonDeg) {
    const double fromNorth = std::clamp(std::round((southDeg + 1 - latDeg) * (kSide - 1)), 0.0, kSide - 1.0);
    const double fromWest = std::clamp(std::round((lonDeg - westDeg) * (kSide - 1)), 0.0, kSide - 1.0);
    return (*posts)[static_cast<size_t>(fromNorth) * kSide + static_cast<size_t>(fromWest)];
  });
}

}  // namespace

TEST_CASE("The error is bounded on made surfaces") {
  const auto ridges = [](double lat, double lon) { return 400.0 * std::abs(std::sin(700 * lon + 300 * lat)); };
  const auto cone = [](double lat, double lon) {
    return std::max(0.0, 1500.0 - 60000.0 * std::hypot(lat - 47.26, lon - 11.39));
  };
  const auto noise = [](double lat, double lon) {
    return 20.0 * std::fmod(std::abs(std::sin(lat * 12989.8 + lon * 78233.0) * 43758.5), 1.0);
  };
  const auto cliff = [](double lat, double lon) { return lon + 0.3 * lat > 25.571 ? 500.0 : 3.0; };
  for (const int level : {10, 12, 14}) {
    const TileKey key = TileKey::containing(47.26, 11.39, level);
    checkGuarantee(PostSurface(1200, [](double, double) { return 100.0; }), key, toleranceOf(level));
    checkGuarantee(PostSurface(1200, ridges), key, 8 * toleranceOf(level), 20000);
    checkGuarantee(PostSurface(1200, cone), key, toleranceOf(level));
    checkGuarantee(PostSurface(1200, noise), key, 8 * toleranceOf(level), 20000);
    // A wall of 83 degrees: rounding sideways by a lattice step is an error of eight.
    checkGuarantee(PostSurface(1200, cliff), key, 4 * toleranceOf(level), 20000);
  }
}

TEST_CASE("The error is bounded on the bare ellipsoid, from octants down") {
  const PostSurface sea(0, [](double, double) { return 0.0; });
  for (int level = 0; level <= 12; level += 2) {
    checkGuarantee(sea, TileKey::containing(12.3, -150.2, level), toleranceOf(level));
    checkGuarantee(sea, TileKey::containing(-89.99, 20.0, level), toleranceOf(level));
  }
}

TEST_CASE("The error is bounded on a rough globe: coarse tiles, poles, the date line") {
  const PostSurface globe(8, roughGlobeM);
  for (int level = 0; level <= 6; level += 2) {
    checkGuarantee(globe, TileKey::containing(89.99, 100.0, level), toleranceOf(level), 10000);
    checkGuarantee(globe, TileKey::containing(-40.0, 179.99, level), toleranceOf(level), 10000);
    checkGuarantee(globe, TileKey::containing(20.0, -179.99, level), toleranceOf(level), 10000);
  }
}

TEST_CASE("The error is bounded on real mountains") {
  const std::optional<PostSurface> tatras = readDegree("carpathia/N49E020.hgt", 49, 20);
  if (!tatras) {
    WARN("no dem/carpathia/N49E020.hgt under " << eye::test::kTestData << ": not tested");
    return;
  }
  for (int level = 8; level <= 14; ++level) {
    checkGuarantee(*tatras, TileKey::containing(49.18, 20.1, level), toleranceOf(level), 20000);
  }
}

TEST_CASE("Neighbours of one level share their edges' lattice points and normals") {
  const PostSurface globe(16, roughGlobeM);
  size_t compared = 0;
  // The sides' fours: inside an octant, the 45 degree halving from below and above, the equator, lon 0, 90, 180, poles.
  for (const LatLon p : {LatLon{30, 30},
                         {44.9, 70},
                         {45.1, 70},
                         {67.4, -70},
                         {67.6, -70},
                         {0.1, 50},
                         {-0.1, -120},
                         {20, 0.1},
                         {20, -0.1},
                         {33, 89.9},
                         {-33, 90.1},
                         {50, 179.9},
                         {-50, -179.9},
                         {89.9, 10},
                         {-89.9, -100},
                         {84.5, 179.9}}) {
    const TileKey key = TileKey::containing(p.latDeg, p.lonDeg, 6);
    compared += checkSides(globe, key, 100.0);
    // The finer tile's tolerance holds for the edge.
    for (const bool isOdd : {false, true})
      checkSides(globe, key, [=](const TileKey& tile) {
        return (tile.row() + tile.column() + tile.columns()) % 2 == (isOdd ? 1u : 0u) ? 100.0 : 20.0;
      });
  }
  CHECK(compared > 400);
  for (int octant = 0; octant < kOctants; ++octant) {
    checkSides(PostSurface(2, roughGlobeM), TileKey::octantRoot(octant), 2000.0);
  }
}

TEST_CASE("Real neighbours share their edges") {
  const std::optional<PostSurface> tatras = readDegree("carpathia/N49E020.hgt", 49, 20);
  if (!tatras) {
    WARN("no dem/carpathia/N49E020.hgt under " << eye::test::kTestData << ": not tested");
    return;
  }
  for (const int level : {10, 12, 14}) CHECK(checkSides(*tatras, TileKey::containing(49.2, 20.2, level), 1.0) > 40);
}

TEST_CASE("Triangles turn counterclockwise and close up to the boundary loop") {
  const PostSurface globe(8, roughGlobeM);
  for (const LatLon p : {LatLon{30, 30}, {-44.9, 70}, {89.9, 10}, {-89.9, -100}, {12, -179.9}}) {
    for (const int level : {2, 5, 8}) {
      checkTopology(meshTile(globe, TileKey::containing(p.latDeg, p.lonDeg, level), toleranceOf(level)));
    }
  }
  for (int octant = 0; octant < kOctants; ++octant) {
    checkTopology(meshTile(PostSurface(0, [](double, double) { return 0.0; }), TileKey::octantRoot(octant), 4096.0));
  }
}

TEST_CASE("A tile's mesh depends on nothing but its arguments") {
  const PostSurface globe(8, roughGlobeM);
  const TileKey key = TileKey::containing(47.0, 11.0, 7);
  const MeshedTile first = meshTile(globe, key, 40.0);
  meshTile(globe, TileKey::containing(-89.0, 11.0, 5), 10.0);
  const MeshedTile second = meshTile(globe, key, 40.0);
  CHECK(first.mesh.vertices == second.mesh.vertices);
  CHECK(first.mesh.indices == second.mesh.indices);
  CHECK(first.meta.geometricErrorM == second.meta.geometricErrorM);
}

TEST_CASE("A cliff too high for the level's lattice gets a coarser one") {
  const PostSurface cliff(1200, [](double, double lon) { return lon < 20.0 ? 0.0 : 4000.0; });
  const TileKey key = TileKey::containing(10.001, 19.999, 15);
  const MeshedTile tile = meshTile(cliff, key, 10.0);
  CHECK(tile.meta.latticeShift > 0);
  CHECK(tile.meta.geometricErrorM <= 10.0);
  checkTopology(tile);
  const Measured measured = measure(cliff, tile, 10.0, 5000);
  CHECK(measured.errorM <= tile.meta.geometricErrorM + 1e-6);
  CHECK(measured.missed == 0);
}

TEST_CASE("Vertices carry the cell's parameters and the surface's normals") {
  // A slope of 1 : 10 down to the east.
  const PostSurface slope(0, [](double, double lon) { return -0.1 * radFromDeg(lon - 20.0) * kSemiMajorM; });
  const TileKey key = TileKey::containing(1.0, 20.0, 10);
  const MeshedTile tile = meshTile(slope, key, 1.0);
  const std::vector<Vec3d> positions = positionsOf(tile);
  for (size_t i = 0; i < positions.size(); ++i) {
    const ChunkVertex& v = tile.mesh.vertices[i];
    const Geodetic g = geodeticFromEcef(positions[i]);
    const TileParam param = paramFromLatLon(key, {g.latDeg, g.lonDeg});
    CHECK(v.s / 65535.0 == Approx(param.s).margin(1e-4));
    CHECK(v.t / 65535.0 == Approx(param.t).margin(1e-4));
    CHECK(v.skirtSides == 0);
    const glm::vec3 normal = normalFromOctahedral(glm::vec2(v.normalU, v.normalV) / 32767.0f);
    const Vec3d expected = ecefFromEnu(g.latDeg, g.lonDeg) * glm::normalize(Vec3d(0.1, 0.0, 1.0));
    CHECK(glm::dot(Vec3d(normal), expected) > 0.99999);
  }
}

TEST_CASE("Bounds hold the mesh, and what the horizon hides is hidden") {
  const PostSurface globe(8, roughGlobeM);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  const Vec3d toScaled(1.0 / kSemiMajorM, 1.0 / kSemiMajorM, 1.0 / kSemiMinorM);
  // Cozzi & Ring (2011): behind the tangent plane and inside the tangent cone.
  const auto isHidden = [](const Vec3d& eye, const Vec3d& p) {
    const Vec3d toPoint = p - eye;
    const double horizon2 = glm::dot(eye, eye) - 1.0, along = -glm::dot(toPoint, eye);
    return along > horizon2 && along * along > horizon2 * glm::dot(toPoint, toPoint);
  };
  size_t hidden = 0;
  for (const int level : {0, 2, 5, 8}) {
    const MeshedTile tile = meshTile(globe, TileKey::containing(47.0, 11.0, level), toleranceOf(level) / 4);
    const ChunkMeta& meta = tile.meta;
    const std::vector<Vec3d> positions = positionsOf(tile);
    for (const Vec3d& p : positions) {
      CHECK(glm::length(p - meta.sphereCentreEcefM) <= meta.sphereRadiusM);
      for (const Vec3d& axis : meta.box.halfAxesEcefM) {
        CHECK(std::abs(glm::dot(p - meta.box.centreEcefM, axis)) <= glm::dot(axis, axis));
      }
      const double heightM = geodeticFromEcef(p).altM;
      CHECK(heightM >= meta.minHeightM);
      CHECK(heightM <= meta.maxHeightM);
    }
    for (int i = 0; i < 300; ++i) {
      const Vec3d eye = ecefFromGeodetic({180 * share(random) - 90, 360 * share(random) - 180,
                                          2000.0 * std::exp(8.0 * share(random))}) *
                        toScaled;
      if (!isHidden(eye, meta.horizonPointScaled)) continue;
      ++hidden;
      const size_t visible = static_cast<size_t>(std::count_if(positions.begin(), positions.end(), [&](const Vec3d& p) {
        const Vec3d scaled = p * toScaled;
        return glm::dot(scaled, scaled) >= 1.0 && !isHidden(eye, scaled);
      }));
      CHECK(visible == 0);
    }
  }
  CHECK(hidden > 300);
}
