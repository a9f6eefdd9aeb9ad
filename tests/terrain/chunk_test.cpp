#include "terrain/chunk.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>
#include <set>

#include <catch2/catch.hpp>

namespace eye {
namespace {

// A cell as a fan about its middle, whose vertices lie on the lattice; `edges` by side. Good enough to hang skirts on.
ChunkMesh fanMesh(const TileKey& key, std::array<uint16_t, 4> edges, const LatticePoint& origin) {
  const TileBounds b = key.bounds();
  ChunkMesh mesh;
  mesh.boundary = edges;
  const double stepM = latticeStepM(key.level());
  const auto add = [&](double latDeg, double lonDeg) {
    const LatticePoint p = latticeFromEcef(ecefFromGeodetic({latDeg, lonDeg, 0}), stepM) - origin;
    REQUIRE(glm::all(glm::lessThanEqual(glm::abs(p), LatticePoint(32767))));
    mesh.vertices.push_back(
        ChunkVertex{static_cast<int16_t>(p.x), static_cast<int16_t>(p.y), static_cast<int16_t>(p.z), 0, 0, 0, 0, 0});
  };
  for (const Side side : kSides) {
    const uint16_t count = edges[static_cast<size_t>(side)];
    for (uint16_t i = 0; i < count; ++i) {
      const double f = static_cast<double>(i) / count;
      switch (side) {
        case Side::south:
          add(b.southDeg, std::lerp(b.westDeg, b.eastDeg, f));
          break;
        case Side::east:
          add(std::lerp(b.southDeg, b.northDeg, f), b.eastDeg);
          break;
        case Side::north:
          add(b.northDeg, std::lerp(b.eastDeg, b.westDeg, f));
          break;
        case Side::west:
          add(std::lerp(b.northDeg, b.southDeg, f), b.westDeg);
          break;
      }
    }
  }
  const uint16_t loop = static_cast<uint16_t>(mesh.vertices.size());
  add((b.southDeg + b.northDeg) / 2, (b.westDeg + b.eastDeg) / 2);
  for (uint16_t i = 0; i < loop; ++i) {
    const uint16_t next = static_cast<uint16_t>((i + 1) % loop);
    mesh.indices.insert(mesh.indices.end(), {i, next, loop});
  }
  return mesh;
}

LatticePoint centreLattice(const TileKey& key) {
  const TileBounds b = key.bounds();
  const Vec3d centre = ecefFromGeodetic({(b.southDeg + b.northDeg) / 2, (b.westDeg + b.eastDeg) / 2, 0});
  return latticeFromEcef(centre, latticeStepM(key.level()));
}

TEST_CASE("the lattice's step is a power of two that holds the cell") {
  CHECK(latticeStepM(14) == 1.0 / 32);
  CHECK(latticeStepM(13) == 1.0 / 16);
  for (int level = 0; level <= kMaxLevel; ++level) {
    int exponent = 0;
    CHECK(std::frexp(latticeStepM(level), &exponent) == 0.5);
    if (level > 0) CHECK(latticeStepM(level) <= latticeStepM(level - 1));
  }
}

TEST_CASE("every cell with its relief fits 16 bits about its middle") {
  for (int level = 0; level <= kMaxLevel; ++level) {
    const double stepM = latticeStepM(level);
    const double cellHeightM = 10'001'966.0 / std::exp2(level);
    const double reliefM = std::min(9000.0, cellHeightM);
    const uint32_t rows = uint32_t{1} << level;
    for (const uint32_t row :
         std::set<uint32_t>{0, rows / 4, rows / 2, rows * 3 / 4, rows - 1 - (rows > 1 ? 1 : 0), rows - 1}) {
      const TileKey key = TileKey::fromGrid(level, 5, row, 0);
      const TileBounds b = key.bounds();
      // The origin is chosen by whoever makes the chunk; the middle of the box about its extremes always serves.
      Vec3d low(1e9), high(-1e9);
      for (double t = 0; t <= 1; t += 0.125)
        for (double s = 0; s <= 1; s += 0.125)
          for (const double altM : {0.0, reliefM}) {
            const Vec3d p =
                ecefFromGeodetic({std::lerp(b.southDeg, b.northDeg, t), std::lerp(b.westDeg, b.eastDeg, s), altM});
            low = glm::min(low, p);
            high = glm::max(high, p);
          }
      const Vec3d steps = (high - low) / stepM;
      CAPTURE(key.name());
      REQUIRE(std::max({steps.x, steps.y, steps.z}) < 65535.0);
    }
  }
}

TEST_CASE("lattice points are the nearest, and exact where a point lies on the lattice") {
  CHECK(latticeFromEcef(Vec3d(1.9, -1.9, 0.26), 0.5) == LatticePoint(4, -4, 1));
  const LatticePoint p(204'000'001, -3, 77);
  CHECK(latticeFromEcef(ecefFromLattice(p, 1.0 / 32), 1.0 / 32) == p);
}

TEST_CASE("a chunk's own step doubles with its shift") {
  ChunkMeta meta;
  meta.key = TileKey::fromGrid(14, 0, 100, 7);
  CHECK(meta.stepM() == 1.0 / 32);
  meta.latticeShift = 3;
  CHECK(meta.stepM() == 0.25);
}

struct SkirtCase {
  TileKey key;
  std::array<uint16_t, 4> edges;
};

std::vector<SkirtCase> skirtCases() {
  return {
      {TileKey::fromGrid(6, 0, 20, 5), {3, 1, 2, 4}},  // ordinary, north-east
      {TileKey::fromGrid(6, 7, 20, 5), {2, 2, 1, 1}},  // ordinary, south-west
      {TileKey::fromGrid(6, 1, 63, 0), {4, 2, 0, 3}},  // at the north pole
      {TileKey::fromGrid(6, 6, 63, 0), {0, 3, 5, 2}},  // at the south pole
  };
}

TEST_CASE("each side has a strip of skirt, and rims share corners") {
  for (const SkirtCase& c : skirtCases()) {
    CAPTURE(c.key.name());
    ChunkMesh mesh = fanMesh(c.key, c.edges, centreLattice(c.key));
    const ChunkMesh surface = mesh;
    const auto ranges = appendSkirts(mesh);
    const size_t loop = static_cast<size_t>(c.edges[0] + c.edges[1] + c.edges[2] + c.edges[3]);
    REQUIRE(mesh.vertices.size() == surface.vertices.size() + loop);
    REQUIRE(std::equal(surface.vertices.begin(), surface.vertices.end(), mesh.vertices.begin()));
    REQUIRE(std::equal(surface.indices.begin(), surface.indices.end(), mesh.indices.begin()));

    size_t expectedFirst = surface.indices.size();
    for (const Side side : kSides) {
      const SkirtRange range = ranges[static_cast<size_t>(side)];
      REQUIRE(range.firstIndex == expectedFirst);
      REQUIRE(range.indexCount == 6u * c.edges[static_cast<size_t>(side)]);
      expectedFirst += range.indexCount;
      // Every rim vertex of the side knows that it hangs from it.
      for (uint32_t i = range.firstIndex; i < range.firstIndex + range.indexCount; ++i) {
        const uint16_t index = mesh.indices[i];
        if (index >= surface.vertices.size())
          REQUIRE((mesh.vertices[index].skirtSides & 1u << static_cast<unsigned>(side)) != 0);
      }
    }
    REQUIRE(expectedFirst == mesh.indices.size());

    size_t corners = 0;
    for (size_t i = 0; i < loop; ++i) {
      ChunkVertex rim = mesh.vertices[surface.vertices.size() + i];
      const int bits = std::popcount(rim.skirtSides);
      REQUIRE((bits == 1 || bits == 2));
      corners += bits == 2 ? 1 : 0;
      rim.skirtSides = 0;
      REQUIRE(rim == surface.vertices[i]);  // all else is its upper vertex's
    }
    REQUIRE(corners == (c.key.isPolar() ? 3u : 4u));
  }
}

TEST_CASE("skirts face outwards") {
  for (const SkirtCase& c : skirtCases()) {
    CAPTURE(c.key.name());
    const LatticePoint origin = centreLattice(c.key);
    ChunkMesh mesh = fanMesh(c.key, c.edges, origin);
    const size_t surfaceVertices = mesh.vertices.size();
    const size_t surfaceIndices = mesh.indices.size();
    appendSkirts(mesh);
    const TileBounds b = c.key.bounds();
    const Vec3d up = upAt((b.southDeg + b.northDeg) / 2, (b.westDeg + b.eastDeg) / 2);
    const double dropSteps = 500;  // as the vertex shader hangs them
    const auto position = [&](size_t index) {
      const ChunkVertex& v = mesh.vertices[index];
      return Vec3d(v.x, v.y, v.z) - (index >= surfaceVertices ? up * dropSteps : Vec3d(0));
    };
    const Vec3d middle = position(surfaceVertices - 1);
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
      const Vec3d p = position(mesh.indices[i]), q = position(mesh.indices[i + 1]), r = position(mesh.indices[i + 2]);
      const Vec3d normal = glm::cross(q - p, r - p);
      if (i < surfaceIndices) {
        REQUIRE(glm::dot(normal, up) > 0);
      } else {
        const Vec3d outwards = p - middle - up * glm::dot(p - middle, up);
        REQUIRE(glm::dot(normal, outwards) > 0);
      }
    }
  }
}

TEST_CASE("octahedral normals come back, also through 16 bits") {
  std::mt19937_64 random(8);
  std::normal_distribution<float> normal;
  double worstDeg = 0;
  const auto check = [&](const glm::vec3& unit) {
    const glm::vec2 o = octahedralFromNormal(unit);
    REQUIRE(std::max(std::abs(o.x), std::abs(o.y)) <= 1.0f);
    REQUIRE(glm::length(normalFromOctahedral(o) - unit) < 1e-6f);
    const glm::vec2 snorm = glm::round(o * 32767.0f) / 32767.0f;
    worstDeg = std::max(worstDeg, degFromRad(static_cast<double>(glm::length(normalFromOctahedral(snorm) - unit))));
  };
  for (int i = 0; i < 100'000; ++i) check(glm::normalize(glm::vec3(normal(random), normal(random), normal(random))));
  for (const float sign : {-1.0f, 1.0f}) {
    check({sign, 0, 0});
    check({0, sign, 0});
    check({0, 0, sign});
    check(glm::normalize(glm::vec3(sign, 1, -1e-7f)));
  }
  CHECK(worstDeg < 0.006);  // a step of 1/32767 and its fold
}

}  // namespace
}  // namespace eye
