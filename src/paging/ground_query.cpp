#include "paging/ground_query.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include <GeographicLib/Math.hpp>

namespace eye {
namespace {

// A line of sight, with what its tests against bounds share.
struct Sight {
  Vec3d from, way;
  double perLengthSquared = 0;
};

// The foot of a plumb line, on the ellipsoid, and its way up: half the time of asking for each by itself.
struct Plumb {
  Vec3d footEcefM, up;
};
Plumb plumbAt(double latDeg, double lonDeg) {
  constexpr double kEccentricitySquared = kFlattening * (2 - kFlattening);
  double sinLat = 0, cosLat = 0, sinLon = 0, cosLon = 0;
  GeographicLib::Math::sincosd(latDeg, sinLat, cosLat);
  GeographicLib::Math::sincosd(lonDeg, sinLon, cosLon);
  const Vec3d up(cosLat * cosLon, cosLat * sinLon, sinLat);
  const double primeVerticalM = kSemiMajorM / std::sqrt(1 - kEccentricitySquared * sinLat * sinLat);
  return {primeVerticalM * Vec3d(up.x, up.y, (1 - kEccentricitySquared) * up.z), up};
}

bool meetsSphere(const GroundTree::Node& node, const Sight& sight) {
  const Vec3d toCentre = node.sphereCentreEcefM - sight.from;
  const double along = std::clamp(glm::dot(toCentre, sight.way) * sight.perLengthSquared, 0.0, 1.0);
  const Vec3d apart = toCentre - sight.way * along;
  return glm::dot(apart, apart) <= node.sphereRadiusM * node.sphereRadiusM;
}

// Where a line enters a node's box, as a share of its way; nothing where it misses it.
std::optional<double> entryOf(const GroundTree::Node& node, const Sight& sight) {
  const Vec3d fromCentre = sight.from - node.boxCentreEcefM;
  double enters = 0, leaves = 1;
  for (const size_t i : {size_t{2}, size_t{0}, size_t{1}}) {  // upwards first: most lines pass above
    const double at = glm::dot(fromCentre, node.boxAxes[i]), speed = glm::dot(sight.way, node.boxAxes[i]);
    const double extentM = node.boxExtentsM[i], end = at + speed;
    if (std::min(at, end) > extentM || std::max(at, end) < -extentM) return std::nullopt;
    if (std::max(std::abs(at), std::abs(end)) <= extentM) continue;  // between the planes all the way
    const double per = 1 / speed, first = (-extentM - at) * per, second = (extentM - at) * per;
    enters = std::max(enters, std::min(first, second));
    leaves = std::min(leaves, std::max(first, second));
  }
  return enters <= leaves ? std::optional(enters) : std::nullopt;
}

}  // namespace

Result<GroundQuery> GroundQuery::open(const std::string& databasePath) {
  Result<DatabaseReader> reader = DatabaseReader::open(databasePath);
  if (!reader) return tl::unexpected(reader.error());
  return GroundQuery(std::move(*reader));
}

Result<GroundHit> GroundQuery::under(double latDeg, double lonDeg) {
  if (const auto begun = tree_.begin(); !begun) return tl::unexpected(begun.error());
  const auto leaf = tree_.leafAt(latDeg, lonDeg);
  if (!leaf) return tl::unexpected(leaf.error());
  const auto found = tree_.surfaceOf(*leaf);
  if (!found) return tl::unexpected(found.error());
  const SurfaceGrid& surface = **found;

  // The plumb line, a metre beyond the ground's heights.
  const double topM = surface.maxHeightM() + 1, deepM = topM - (surface.minHeightM() - 1);
  const Plumb plumb = plumbAt(latDeg, lonDeg);
  const Vec3d top = plumb.footEcefM + plumb.up * topM, way = -deepM * plumb.up;
  // The triangle that it goes through, or comes nearest to: a chunk's edges are chords of its cell's.
  auto hit = surface.cast(top, way, 1);
  if (!hit) {
    const SurfaceGrid::Nearest nearest = surface.nearest(top, way);
    if (nearest.crossing.inside < -1)
      return fail(ErrorKind::badData,
                  fmt::format("{} has no triangle under {} {}", tree_.node(*leaf).key.name(), latDeg, lonDeg));
    hit = SurfaceGrid::Hit{nearest.crossing.along, nearest.triangle};
  }
  return GroundHit{
      {latDeg, lonDeg, topM - deepM * hit->along}, top + way * hit->along, surface.normalEcef(hit->triangle)};
}

// Chunks by and by as the line enters their boxes, parents before children, until none that is left comes before the
// nearest hit. Siblings wait in this order on a stack, so that what is near is looked at first.
Result<std::optional<GroundHit>> GroundQuery::between(const Vec3d& fromEcefM, const Vec3d& toEcefM) {
  if (const auto begun = tree_.begin(); !begun) return tl::unexpected(begun.error());
  Sight sight{fromEcefM, toEcefM - fromEcefM};
  const double lengthSquared = glm::dot(sight.way, sight.way);
  if (lengthSquared > 0) sight.perLengthSquared = 1 / lengthSquared;

  int looked = 0;
  waiting_.clear();
  // The children of one node, the farthest of them first onto the stack.
  const auto push = [&](GroundTree::NodeNumber first, uint32_t count, double nearestAlong) {
    const size_t begin = waiting_.size();
    for (GroundTree::NodeNumber number = first; number < first + count; ++number) {
      ++looked;
      const GroundTree::Node& node = tree_.node(number);
      if (!meetsSphere(node, sight)) continue;
      const auto enters = entryOf(node, sight);
      if (!enters || *enters > nearestAlong) continue;
      waiting_.push_back({*enters, number});
      for (size_t i = waiting_.size() - 1; i > begin && waiting_[i].enters > waiting_[i - 1].enters; --i)
        std::swap(waiting_[i], waiting_[i - 1]);
    }
  };

  double nearestAlong = 1;
  std::optional<GroundHit> nearest;
  push(0, kOctants, nearestAlong);
  while (!waiting_.empty()) {
    const Waiting next = waiting_.back();
    waiting_.pop_back();
    if (next.enters > nearestAlong) continue;
    if (!tree_.node(next.node).isLeaf) {
      const auto first = tree_.childrenOf(next.node);
      if (!first) return tl::unexpected(first.error());
      push(*first, tree_.node(next.node).childCount, nearestAlong);
      if (looked > kMostChunks)
        return fail(ErrorKind::unsupported, fmt::format("a line of sight meets more than {} chunks", kMostChunks));
      continue;
    }
    const auto surface = tree_.surfaceOf(next.node);
    if (!surface) return tl::unexpected(surface.error());
    const auto hit = (*surface)->cast(fromEcefM, sight.way, nearestAlong);
    if (!hit) continue;
    nearestAlong = hit->along;
    nearest = GroundHit{{}, fromEcefM + sight.way * hit->along, (*surface)->normalEcef(hit->triangle)};
  }
  if (nearest) nearest->position = geodeticFromEcef(nearest->ecefM);
  return nearest;
}

}  // namespace eye
