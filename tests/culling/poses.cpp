#include "culling/poses.h"

#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

namespace eye::test {
namespace {

constexpr double kLowestM = 30, kFarthestM = 62'763'000;

double uniform(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution(low, high)(random);
}

DatabaseReader opened(const std::string& database) {
  Result<DatabaseReader> reader = DatabaseReader::open(database);
  if (!reader) FAIL(reader.error().message);
  return std::move(*reader);
}

void turn(std::mt19937& random, Eye& eye) {
  eye.pose.headingDeg = uniform(random, 0, 360);
  const bool isAcrobatic = random() % 3 == 0;
  eye.pose.pitchDeg = isAcrobatic ? uniform(random, -90, 90) : uniform(random, -35, 15);
  // From far up the Earth is small and below.
  if (eye.pose.position.altM > 30000 && random() % 4 != 0) eye.pose.pitchDeg = uniform(random, -90, -10);
  if (eye.pose.position.altM > 3e6 && random() % 4 != 0) eye.pose.pitchDeg = uniform(random, -90, -60);
  eye.pose.rollDeg = isAcrobatic ? uniform(random, -180, 180) : uniform(random, -60, 60);
  eye.fovDeg = random() % 4 == 0 ? uniform(random, 5, 120) : 60;
  eye.isOffAxis = random() % 4 == 0;
}

}  // namespace

Ground::Ground(const std::string& database) : reader_(opened(database)) {}

double Ground::highestM(double latDeg, double lonDeg) const {
  double heightM = 0;
  for (int level = 0; level <= kMaxLevel; ++level) {
    const Result<ChunkMeta> meta = reader_.readMeta(TileKey::containing(latDeg, lonDeg, level));
    if (!meta) break;
    heightM = meta->maxHeightM;
  }
  return heightM;
}

View Eye::view(int widthPx, int heightPx) const {
  Frustum frustum = symmetricFrustum(fovDeg, widthPx, heightPx, 1);
  if (isOffAxis) {
    const double right = 0.7 * (frustum.tanRight - frustum.tanLeft), up = -0.4 * (frustum.tanTop - frustum.tanBottom);
    frustum.tanLeft += right;
    frustum.tanRight += right;
    frustum.tanBottom += up;
    frustum.tanTop += up;
  }
  return makeView(pose, frustum, widthPx, heightPx);
}

std::string Eye::text() const {
  const Geodetic& at = pose.position;
  return fmt::format("{:.9f},{:.9f},{:.6f},{:.9f},{:.9f},{:.9f} fov {:.6f}{}", at.latDeg, at.lonDeg, at.altM,
                     pose.headingDeg, pose.pitchDeg, pose.rollDeg, fovDeg, isOffAxis ? " off axis" : "");
}

Eye randomEye(std::mt19937& random, const Ground& ground, const TileBounds* near) {
  Eye eye;
  Geodetic& at = eye.pose.position;
  if (near != nullptr) {
    at.latDeg = uniform(random, near->southDeg, near->northDeg);
    at.lonDeg = uniform(random, near->westDeg, near->eastDeg);
  } else {
    at.latDeg = degFromRad(std::asin(uniform(random, -1, 1)));
    at.lonDeg = uniform(random, -180, 180);
    if (random() % 4 == 0) at.latDeg = (random() % 2 == 0 ? 90 : -90) * (1 - 0.001 * double(random() % 3));
    if (random() % 3 == 0) at.latDeg = (random() % 2 == 0 ? 45.0 : -67.5) + uniform(random, -0.2, 0.2);
    if (random() % 4 == 0) at.lonDeg = 180 - 0.01 * double(random() % 3);
  }
  const double share = uniform(random, 0, 1);
  at.altM = ground.highestM(at.latDeg, at.lonDeg) + kLowestM * std::pow(kFarthestM / kLowestM, share * share);
  turn(random, eye);
  return eye;
}

Eye turned(std::mt19937& random, const Eye& eye) {
  Eye other = eye;
  turn(random, other);
  return other;
}

Eye flightEye(int number, const Ground& ground, const TileBounds& bounds) {
  const double t = number, turnRad = 6.283185307179586 * t / 180;
  const auto placeAt = [&](double frame) {
    // A wave across the way east, then back on another line.
    const double along = 1 - std::abs(std::fmod(frame * 0.0002, 2.0) - 1), wave = 0.012 * std::sin(frame / 28.6);
    return glm::dvec2(0.45 * bounds.southDeg + 0.55 * bounds.northDeg + wave + 0.05 * std::sin(frame / 1700),
                      bounds.westDeg + (0.1 + 0.8 * along) * (bounds.eastDeg - bounds.westDeg));
  };
  const glm::dvec2 here = placeAt(t), next = placeAt(t + 1);
  Eye eye;
  eye.pose.position = {here.x, here.y, 0};
  double heightM = 0;
  for (int ahead = 0; ahead <= 40; ahead += 8) {  // climbs before the ridge
    const glm::dvec2 at = placeAt(t + ahead);
    heightM = std::max(heightM, ground.highestM(at.x, at.y) - 8.0 * ahead);
  }
  eye.pose.position.altM = heightM + 60;
  const double east = (next.y - here.y) * std::cos(radFromDeg(here.x));
  eye.pose.headingDeg = degFromRad(std::atan2(east, next.x - here.x));
  eye.pose.pitchDeg = 12 * std::sin(turnRad * 0.7);
  eye.pose.rollDeg = 80 * std::sin(turnRad);
  return eye;
}

}  // namespace eye::test
