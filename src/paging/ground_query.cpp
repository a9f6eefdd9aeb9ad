#include "paging/ground_query.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include <GeographicLib/Math.hpp>

namespace eye {
namespace {

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

struct Waiting {
  float enters = 0;
  GroundTree::NodeNumber node = 0;
};

// Cells own their south and west edges; beyond the others it is sea.
bool holdsData(const TileBounds& data, double latDeg, double lonDeg) {
  if (latDeg < data.southDeg || latDeg > data.northDeg) return false;
  const double eastwardsDeg = std::remainder(lonDeg - data.westDeg, 360.0);
  return (eastwardsDeg < 0 ? eastwardsDeg + 360 : eastwardsDeg) <= data.eastDeg - data.westDeg;
}

tl::unexpected<Error> tooCoarse(const GroundTree::Node& node) {
  return fail(ErrorKind::unsupported,
              fmt::format("the terrain of {} is known to {:.0f} m only", node.key.name(), node.errorM));
}

// The part of a way within a ball about the Earth's centre that holds all terrain, as shares of it.
struct Part {
  double begins, ends;
};
std::optional<Part> partNearEarth(const Vec3d& fromEcefM, const Vec3d& wayEcefM) {
  constexpr double kRadiusM = kSemiMajorM + 50'000;  // the coarsest chunks of a globe bulge by 33 km
  const double a = glm::dot(wayEcefM, wayEcefM), b = glm::dot(fromEcefM, wayEcefM);
  const double c = glm::dot(fromEcefM, fromEcefM) - kRadiusM * kRadiusM;
  if (a == 0) return c <= 0 ? std::optional(Part{0, 1}) : std::nullopt;
  const double inside = b * b - a * c;
  if (inside < 0) return std::nullopt;
  const Part part{std::max((-b - std::sqrt(inside)) / a, 0.0), std::min((-b + std::sqrt(inside)) / a, 1.0)};
  return part.begins <= part.ends ? std::optional(part) : std::nullopt;
}

}  // namespace

Result<GroundQuery> GroundQuery::open(const std::string& databasePath) {
  Result<DatabaseReader> reader = DatabaseReader::open(databasePath);
  if (!reader) return tl::unexpected(reader.error());
  return GroundQuery(std::move(*reader));
}

Result<GroundHit> GroundQuery::under(double latDeg, double lonDeg) {
  if (const auto begun = tree_.begin(); !begun) return tl::unexpected(begun.error());
  if (!holdsData(tree_.info().dataBounds, latDeg, lonDeg)) {
    const Plumb plumb = plumbAt(latDeg, lonDeg);
    return GroundHit{{latDeg, lonDeg, 0}, plumb.footEcefM, plumb.up};
  }
  const auto leaf = tree_.leafAt(latDeg, lonDeg);
  if (!leaf) return tl::unexpected(leaf.error());
  if (tree_.node(*leaf).errorM > kCoarsestM) return tooCoarse(tree_.node(*leaf));
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
  // Of a way into space only what is near the Earth: the rounding of floats grows with its length.
  const auto part = partNearEarth(fromEcefM, toEcefM - fromEcefM);
  if (!part) return std::nullopt;
  const auto placeAt = [&](double share) { return fromEcefM + (toEcefM - fromEcefM) * share; };
  const Sight sight = sightBetween(part->begins > 0 ? placeAt(part->begins) : fromEcefM,
                                   part->ends < 1 ? placeAt(part->ends) : toEcefM);

  int looked = 0;
  float untilAlong = 1;  // the nearest hit, rounded up
  // All that a way down leaves behind on each level, the roots, and room for those that turn out not to be met.
  std::array<Waiting, SiblingBounds::kLanes*(GroundTree::kMostAncestors + kMaxLevel + 1)> waiting;
  size_t count = 0;
  const auto push = [&](const GroundTree::Siblings& siblings) {
    const size_t begin = count;
    const SiblingBounds::Entries entries = siblings.bounds.entriesOf(sight, untilAlong);
    // Without a branch: which are met is beyond a processor's guessing.
    for (uint32_t lane = 0; lane < siblings.count; ++lane) {
      waiting[count] = {entries.along[lane], siblings.first + lane};
      count += static_cast<size_t>(-entries.met[lane]);
    }
    // The farthest of them comes first onto the stack.
    for (size_t added = begin + 1; added < count; ++added)
      for (size_t i = added; i > begin && waiting[i].enters > waiting[i - 1].enters; --i)
        std::swap(waiting[i], waiting[i - 1]);
    looked += static_cast<int>(siblings.count);
  };

  double nearestAlong = 1;
  std::optional<GroundHit> nearest;
  GroundTree::NodeNumber hitNode = 0;
  const auto ancestors = tree_.ancestorsFor(sight);
  if (!ancestors) return tl::unexpected(ancestors.error());
  for (const uint32_t number : *ancestors) push(tree_.siblings(number));
  while (count > 0) {
    const Waiting next = waiting[--count];
    if (next.enters > untilAlong) continue;
    if (!tree_.node(next.node).isLeaf) {
      const auto children = tree_.childrenOf(next.node);
      if (!children) return tl::unexpected(children.error());
      push(**children);
      if (looked > kMostChunks)
        return fail(ErrorKind::unsupported, fmt::format("a line of sight meets more than {} chunks", kMostChunks));
      continue;
    }
    const auto surface = tree_.surfaceOf(next.node);
    if (!surface) return tl::unexpected(surface.error());
    const auto hit = (*surface)->cast(sight.fromEcefM, sight.wayEcefM, nearestAlong);
    if (!hit) continue;
    nearestAlong = hit->along;
    untilAlong = std::nextafter(static_cast<float>(nearestAlong), 2.0F);
    nearest = GroundHit{{}, sight.fromEcefM + sight.wayEcefM * hit->along, (*surface)->normalEcef(hit->triangle)};
    hitNode = next.node;
  }
  if (nearest && tree_.node(hitNode).errorM > kCoarsestM) return tooCoarse(tree_.node(hitNode));
  if (nearest) nearest->position = geodeticFromEcef(nearest->ecefM);
  return nearest;
}

}  // namespace eye
