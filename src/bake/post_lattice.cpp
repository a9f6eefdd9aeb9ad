#include "bake/post_lattice.h"

#include <algorithm>
#include <cmath>

namespace eye {

namespace {

// Files round their spacing and origin in the last digits; a fiftieth of a post is far below what a post is good to.
constexpr double kSnap = 0.02;

PostAxis axisOf(double firstDeg, double stepDeg, int count, double originDeg) {
  PostAxis axis{originDeg, 1 / stepDeg, 0};
  const double whole = axis.perDegree >= 1 ? std::round(axis.perDegree) : 1 / std::round(stepDeg);
  if (std::abs(axis.perDegree / whole - 1) * count < kSnap) axis.perDegree = whole;
  const double first = axis.position(firstDeg);
  axis.phase = first - std::floor(first);
  if (axis.phase > 1 - kSnap || axis.phase < kSnap) axis.phase = 0;
  if (std::abs(axis.phase - 0.5) < kSnap) axis.phase = 0.5;
  return axis;
}

// The index of the first of `count` posts, if all of them lie on the axis.
std::optional<int64_t> firstOn(const PostAxis& axis, double firstDeg, double stepDeg, int count) {
  const double first = axis.position(firstDeg);
  const double last = axis.position(firstDeg + stepDeg * (count - 1));
  const double index = std::round(first);
  if (std::abs(first - index) > kSnap || std::abs(last - (index + count - 1)) > 2 * kSnap) return std::nullopt;
  return static_cast<int64_t>(index);
}

}  // namespace

PostLattice latticeOf(const GeoGrid& grid) {
  PostLattice lattice;
  lattice.lat = axisOf(grid.southDeg, grid.latStepDeg, grid.rows, -90);
  lattice.lon = axisOf(grid.westDeg, grid.lonStepDeg, grid.columns, -180);
  const double turn = 360 * lattice.lon.perDegree;
  if (std::abs(turn - std::round(turn)) < 1e-9 * turn) lattice.turn = static_cast<int64_t>(std::round(turn));
  return lattice;
}

std::optional<PostRect> rectOn(const PostLattice& lattice, const GeoGrid& grid) {
  const auto south = firstOn(lattice.lat, grid.southDeg, grid.latStepDeg, grid.rows);
  const auto west = firstOn(lattice.lon, grid.westDeg, grid.lonStepDeg, grid.columns);
  if (!south || !west) return std::nullopt;
  return PostRect{*south, *west, grid.rows, grid.columns};
}

PostRect intersect(const PostRect& a, const PostRect& b) {
  PostRect c{std::max(a.south, b.south), std::max(a.west, b.west), 0, 0};
  c.rows = std::min(a.north(), b.north()) - c.south + 1;
  c.columns = std::min(a.east(), b.east()) - c.west + 1;
  return c;
}

}  // namespace eye
