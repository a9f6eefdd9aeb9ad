// No chunk that the horizon hides can be seen: a million random eyes and chunks, judged by rays.
#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "bake/mesh_bounds.h"
#include "paging/horizon.h"

namespace eye {
namespace {

class Random {
 public:
  explicit Random(uint32_t seed) : bits_(seed) {}
  double uniform(double low, double high) { return std::uniform_real_distribution<>(low, high)(bits_); }
  double powerOfTen(double low, double high) { return std::pow(10.0, uniform(low, high)); }
  bool oneIn(int n) { return std::uniform_int_distribution<>(1, n)(bits_) == 1; }
  Vec3d direction() {
    const double z = uniform(-1, 1), angle = uniform(0, 6.2831853);
    const double r = std::sqrt(1 - z * z);
    return Vec3d(r * std::cos(angle), r * std::sin(angle), z);
  }

 private:
  std::mt19937 bits_;
};

struct Chunk {
  ChunkMeta meta;
  std::vector<Vec3d> mesh;    // points of its triangles, and those twice its error above and below them
  std::vector<Vec3d> sphere;  // of the bounding sphere, widened by twice the error
};

// Anywhere, of any level, from the deepest trench to the highest peak. Bounds as the bake makes them.
Chunk makeChunk(int level, Random& random) {
  constexpr int kPosts = 5;
  Chunk chunk;
  const Vec3d at = random.direction();
  const double latDeg = random.oneIn(8) ? std::copysign(90 - random.powerOfTen(-6, 1), at.z) : degFromRad(asin(at.z));
  const double lonDeg = degFromRad(std::atan2(at.y, at.x));
  chunk.meta.key = TileKey::containing(latDeg, lonDeg, level);
  const TileBounds b = chunk.meta.key.bounds();
  const double cellM = 1e7 * std::exp2(-level);
  const bool isSea = random.oneIn(3);  // where the bounds are tightest
  const double reliefM = isSea ? 0 : std::min(20e3, random.powerOfTen(-3, 0) * cellM);
  const double baseM = isSea ? 0 : random.uniform(-11e3, 9e3);
  const double errorM = chunk.meta.geometricErrorM = cellM * random.powerOfTen(-5, -2);

  std::vector<Vec3d> vertices;
  const auto addAround = [&](const Vec3d& point, const Vec3d& up) {
    for (const double offM : {0.0, 2 * errorM, -2 * errorM}) chunk.mesh.push_back(point + offM * up);
  };
  for (int row = 0; row < kPosts; ++row) {
    for (int column = 0; column < kPosts; ++column) {
      const Geodetic g{std::lerp(b.southDeg, b.northDeg, row / (kPosts - 1.0)),
                       std::lerp(b.westDeg, b.eastDeg, column / (kPosts - 1.0)),
                       std::clamp(baseM + random.uniform(-reliefM, reliefM), -11e3, 9e3)};
      vertices.push_back(ecefFromGeodetic(g));
      addAround(vertices.back(), upAt(g.latDeg, g.lonDeg));
    }
  }
  for (size_t i = 0; i + kPosts + 1 < vertices.size(); ++i) {
    const Vec3d middle = (vertices[i] + vertices[i + 1] + vertices[i + kPosts + 1]) / 3.0;
    const Geodetic g = geodeticFromEcef(middle);
    addAround(middle, upAt(g.latDeg, g.lonDeg));
  }
  setBounds(vertices, {(b.southDeg + b.northDeg) / 2, (b.westDeg + b.eastDeg) / 2}, chunk.meta);
  for (int i = 0; i < 32; ++i)
    chunk.sphere.push_back(chunk.meta.sphereCentreEcefM + (chunk.meta.sphereRadiusM + 2 * errorM) * random.direction());
  return chunk;
}

// An eye at an angle (at the Earth's centre, radians) from the chunk, on the great circle that begins `sideways`.
Vec3d eyeAt(const Chunk& chunk, const Vec3d& sideways, double angle, double altM) {
  const Vec3d towards = glm::normalize(chunk.meta.sphereCentreEcefM);
  const Vec3d across = glm::normalize(glm::cross(towards, sideways));
  const Vec3d up = std::cos(angle) * towards + std::sin(angle) * across;
  return ecefFromGeodetic(
      {degFromRad(std::asin(std::clamp(up.z, -1.0, 1.0))), degFromRad(std::atan2(up.y, up.x)), altM});
}

// From below the Dead Sea's shore to far out in space.
double randomAltitudeM(Random& random) {
  return random.oneIn(5) ? random.uniform(-400, 10) : random.powerOfTen(0, 8);
}

double randomDepthM(double altM, Random& random) {
  const double depthM = random.oneIn(3) ? 0 : random.powerOfTen(0, 4.3);
  return altM < 0 && random.oneIn(2) ? depthM - altM : depthM;
}

// Mostly where the chunk is near the horizon.
double randomAngle(const Chunk& chunk, double altM, Random& random) {
  const double dip = std::acos(1 / (1 + std::max(altM, 1.0) / kSemiMinorM));
  const double size = std::min(1.5, 2 * chunk.meta.sphereRadiusM / kSemiMinorM);
  return random.oneIn(3) ? random.uniform(0, 3.1415926) : std::min(3.1, random.uniform(0.5, 2) * (dip + size));
}

// Whether an ellipsoid round the origin hides the point. One under its surface is hidden when the surface above it is
// beyond the horizon: where the eye sees the occluder's surface, no terrain may lie below it.
bool isHidden(const Vec3d& eyeM, const Vec3d& pointM, const Vec3d& semiAxesM) {
  const Vec3d eye = eyeM / semiAxesM, point = pointM / semiAxesM;
  const double length = glm::length(point);
  if (length <= 1.0) return glm::dot(point, eye) <= length;
  const Vec3d along = point - eye;
  const double t = std::clamp(-glm::dot(eye, along) / glm::dot(along, along), 0.0, 1.0);
  const Vec3d nearest = eye + t * along;
  return glm::dot(nearest, nearest) <= 1.0;
}

// What each of the tests promises, against an occluder that lies at least `depthM` below the ellipsoid.
bool keepsPromise(const Chunk& chunk, const Vec3d& eyeM, double depthM, HorizonTest test) {
  constexpr double kRoundingM = 1e-3;
  Vec3d semiAxesM = Vec3d(kSemiMajorM, kSemiMajorM, kSemiMinorM) - 1.00005 * depthM + kRoundingM;
  const auto hidden = [&](const Vec3d& pointM) { return isHidden(eyeM, pointM, semiAxesM); };
  if (test == HorizonTest::ellipsoid) return std::ranges::all_of(chunk.mesh, hidden);
  semiAxesM = Vec3d(semiAxesM.z);
  const Vec3d centreM = chunk.meta.sphereCentreEcefM, sight = glm::normalize(centreM - eyeM);
  const Vec3d highest = glm::normalize(centreM - glm::dot(centreM, sight) * sight);  // seen from the eye
  return std::ranges::all_of(chunk.mesh, hidden) && std::ranges::all_of(chunk.sphere, hidden) &&
         hidden(centreM + (chunk.meta.sphereRadiusM + 2 * chunk.meta.geometricErrorM) * highest);
}

}  // namespace

TEST_CASE("no chunk that the horizon hides can be seen, by either test") {
  constexpr int kChunks = 4000, kEyes = 250;
  Random random(7);
  int cases = 0, byEllipsoid = 0, byPaper = 0, wrong = 0, under = 0;
  for (int i = 0; i < kChunks; ++i) {
    const Chunk chunk = makeChunk(i % 20, random);
    for (int k = 0; k < kEyes; ++k, ++cases) {
      const double altM = randomAltitudeM(random), depthM = randomDepthM(altM, random);
      const Vec3d eyeM = eyeAt(chunk, random.direction(), randomAngle(chunk, altM, random), altM);
      const Horizon horizon(eyeM, depthM);
      const bool isUnder = altM < -1.004 * depthM;  // the occluder is lowered by up to 0.35 % more
      const bool ellipsoid = horizon.hides(chunk.meta, HorizonTest::ellipsoid);
      const bool paper = horizon.hides(chunk.meta, HorizonTest::paper);
      under += isUnder;
      byEllipsoid += ellipsoid;
      byPaper += paper;
      wrong += isUnder && (ellipsoid || paper);
      wrong += ellipsoid && !keepsPromise(chunk, eyeM, depthM, HorizonTest::ellipsoid);
      wrong += paper && !keepsPromise(chunk, eyeM, depthM, HorizonTest::paper);
    }
  }
  CAPTURE(byEllipsoid, byPaper, under);
  CHECK(cases == 1'000'000);
  CHECK(wrong == 0);
  CHECK(byPaper > 300'000);
  CHECK(byEllipsoid > byPaper);
  CHECK(under > 10'000);
}

TEST_CASE("nor can it where it is hidden only just") {
  for (const HorizonTest test : {HorizonTest::ellipsoid, HorizonTest::paper}) {
    Random random(11);
    int edges = 0, wrong = 0;
    for (int i = 0; i < 20'000; ++i) {
      const Chunk chunk = makeChunk(i % 20, random);
      // Beyond a corner of the chunk, which is the first to come up.
      const Vec3d sideways =
          random.oneIn(2) ? random.direction() : glm::cross(chunk.mesh[0], chunk.meta.sphereCentreEcefM);
      const double altM = randomAltitudeM(random), depthM = randomDepthM(altM, random);
      const auto hides = [&](double angle) {
        return Horizon(eyeAt(chunk, sideways, angle, altM), depthM).hides(chunk.meta, test);
      };
      double seen = 0, hidden = 3.1415926;
      if (!hides(hidden)) continue;
      while (hidden - seen > 1e-9) {
        const double middle = (seen + hidden) / 2;
        (hides(middle) ? hidden : seen) = middle;
      }
      ++edges;
      wrong += !keepsPromise(chunk, eyeAt(chunk, sideways, hidden, altM), depthM, test);
    }
    CAPTURE(test == HorizonTest::paper);
    CHECK(edges > 10'000);
    CHECK(wrong == 0);
  }
}

}  // namespace eye
