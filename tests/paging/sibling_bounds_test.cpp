// Boxes in floats against the same boxes in doubles: a line or ball that meets one is never taken to pass by.
#include "paging/sibling_bounds.h"

#include <catch2/catch.hpp>
#include <random>

#include "geo/frames.h"

namespace eye {
namespace {

class Random {
 public:
  explicit Random(uint64_t seed) : bits_(seed) {}
  double within(double low, double high) { return low + (high - low) * static_cast<double>(bits_() >> 11) * 0x1p-53; }
  Vec3d inCube() { return {within(-1, 1), within(-1, 1), within(-1, 1)}; }
  Vec3d direction() { return glm::normalize(inCube()); }

 private:
  std::mt19937_64 bits_;
};

// As a chunk's of so many metres: flat, anywhere on the Earth.
OrientedBox randomBox(Random& random, const Geodetic& at, double sizeM) {
  const Mat3d ecefFromLocal = ecefFromEnu(at.latDeg, at.lonDeg);
  return {ecefFromGeodetic(at) + ecefFromLocal * (random.inCube() * sizeM),
          {ecefFromLocal[0] * sizeM, ecefFromLocal[1] * (sizeM * random.within(0.5, 1)),
           ecefFromLocal[2] * (sizeM * random.within(0.01, 0.3))}};
}

Vec3d pointOf(const OrientedBox& box, const Vec3d& shares) {
  return box.centreEcefM + box.halfAxesEcefM[0] * shares.x + box.halfAxesEcefM[1] * shares.y +
         box.halfAxesEcefM[2] * shares.z;
}

// On one of the faces.
Vec3d onSurface(Random& random, const OrientedBox& box) {
  Vec3d shares = random.inCube();
  const int axis = static_cast<int>(random.within(0, 3));
  shares[axis] = shares[axis] < 0 ? -1 : 1;
  return pointOf(box, shares);
}

// The point of the box, widened by `byM`, that is nearest to a place is farther than `radiusM` from it.
bool isBeyond(const OrientedBox& box, double byM, const Vec3d& placeEcefM, double radiusM) {
  double squared = 0;
  for (const Vec3d& half : box.halfAxesEcefM) {
    const double halfM = glm::length(half), along = glm::dot(placeEcefM - box.centreEcefM, half / halfM);
    const double apart = std::max(std::abs(along) - halfM - byM, 0.0);
    squared += apart * apart;
  }
  return squared > radiusM * radiusM;
}

TEST_CASE("sibling bounds: a line that touches a box is in it, from where it enters") {
  Random random(1);
  int passed = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Geodetic at{random.within(-90, 90), random.within(-180, 180), 0};
    const double sizeM = std::pow(10, random.within(2, 6.5));
    SiblingBounds bounds;
    std::array<OrientedBox, SiblingBounds::kLanes> boxes;
    for (uint32_t lane = 0; lane < boxes.size(); ++lane) {
      boxes[lane] = randomBox(random, at, sizeM);
      bounds.set(lane, boxes[lane], 0);
    }
    // Through a point of a face, which is often an edge's neighbour, so that the line only just touches the box.
    const auto lane = static_cast<uint32_t>(random.within(0, SiblingBounds::kLanes));
    const Vec3d touched = onSurface(random, boxes[lane]), way = random.direction() * sizeM * random.within(0.01, 50);
    const double share = random.within(0, 1);
    const Sight sight = sightBetween(touched - way * share, touched + way * (1 - share));
    const auto entries = bounds.entriesOf(sight, 1);
    REQUIRE(entries.met[lane] == -1);
    CHECK(entries.along[lane] <= share + 1e-5);
    if (share > 0.01)
      CHECK(bounds.entriesOf(sight, 0.5F * entries.along[lane]).met[lane] == -(entries.along[lane] == 0));
    // Not of use if it took all for met: one that stays clear of a box's sphere is found to.
    for (uint32_t other = 0; other < boxes.size(); ++other) {
      const Vec3d& centre = boxes[other].centreEcefM;
      const double along = glm::clamp(
          glm::dot(centre - sight.fromEcefM, sight.wayEcefM) / glm::dot(sight.wayEcefM, sight.wayEcefM), 0.0, 1.0);
      if (glm::length(sight.fromEcefM + sight.wayEcefM * along - centre) < 2 * sizeM) continue;
      ++passed;
      CHECK(entries.met[other] == 0);
    }
  }
  CHECK(passed > 1000);
}

TEST_CASE("sibling bounds: a ball that touches a box reaches into it, one that doesn't does not") {
  Random random(2);
  int apart = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Geodetic at{random.within(-90, 90), random.within(-180, 180), 0};
    const double sizeM = std::pow(10, random.within(2, 6.5));
    const OrientedBox box = randomBox(random, at, sizeM);
    SiblingBounds bounds;
    bounds.set(2, box, 0);
    const Vec3d touched = onSurface(random, box);
    Ball ball{touched + random.direction() * sizeM * random.within(0.01, 20), 0};
    ball.radiusM = glm::length(ball.centreEcefM - touched);
    CHECK(bounds.reachInto(ball)[2] == -1);
    ball.radiusM *= random.within(0, 1);
    if (!isBeyond(box, 1e-4 * (sizeM + ball.radiusM), ball.centreEcefM, ball.radiusM)) continue;
    ++apart;
    CHECK(bounds.reachInto(ball)[2] == 0);
  }
  CHECK(apart > 1000);
}

TEST_CASE("sibling bounds: lines along faces, without a way, and in boxes without height") {
  const OrientedBox flat{Vec3d(6.4e6, 0, 0), {Vec3d(0, 100, 0), Vec3d(0, 0, 100), Vec3d(0.0)}};
  SiblingBounds bounds;
  bounds.set(0, flat, 0.01);
  const auto met = [&](const Vec3d& from, const Vec3d& to) {
    return bounds.entriesOf(sightBetween(flat.centreEcefM + from, flat.centreEcefM + to), 1).met[0] != 0;
  };
  CHECK(met({50, 0, 0}, {-50, 0, 0}));        // down, across
  CHECK(met({0, -500, 0}, {0, 500, 0}));      // in its plane
  CHECK(met({0, -500, 100}, {0, 500, 100}));  // along an edge
  CHECK(met({0, 10, 10}, {0, 10, 10}));       // a point in it
  CHECK_FALSE(met({0, -500, 101}, {0, 500, 101}));
  CHECK_FALSE(met({0, 10, 130}, {0, 10, 130}));
}

}  // namespace
}  // namespace eye
