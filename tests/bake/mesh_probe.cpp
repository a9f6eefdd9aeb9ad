#include "bake/mesh_probe.h"

#include <algorithm>
#include <cmath>

namespace eye::test {
namespace {

constexpr size_t kBins = 48;

}  // namespace

std::vector<LatticePoint> latticeOf(const MeshedTile& tile) {
  std::vector<LatticePoint> points;
  for (const ChunkVertex& v : tile.mesh.vertices)
    points.push_back(tile.meta.originLattice + LatticePoint(v.x, v.y, v.z));
  return points;
}

std::vector<Vec3d> positionsOf(const MeshedTile& tile) {
  std::vector<Vec3d> positions;
  for (const LatticePoint& p : latticeOf(tile)) positions.push_back(ecefFromLattice(p, tile.meta.stepM()));
  return positions;
}

MeshProbe::MeshProbe(const MeshedTile& tile)
    : positions_(positionsOf(tile)), indices_(tile.mesh.indices), bins_(kBins * kBins) {
  const TileBounds b = tile.meta.key.bounds();
  // Straight edges bulge out of the tile by up to a quarter of the tolerance: wide margins.
  const double marginDeg = (b.northDeg - b.southDeg) * 0.1;
  south_ = b.southDeg - marginDeg;
  north_ = b.northDeg + marginDeg;
  west_ = b.westDeg - marginDeg;
  east_ = b.eastDeg + marginDeg;
  for (size_t t = 0; 3 * t < indices_.size(); ++t) {
    double south = 90, north = -90, west = 540, east = -540;
    for (size_t i = 0; i < 3; ++i) {
      const Geodetic g = geodeticFromEcef(positions_[indices_[3 * t + i]]);
      const double lon = g.lonDeg - 360.0 * std::round((g.lonDeg - (west_ + east_) / 2) / 360.0);
      south = std::min(south, g.latDeg);
      north = std::max(north, g.latDeg);
      west = std::min(west, lon);
      east = std::max(east, lon);
    }
    // Near a pole, and for large triangles, sides bend far out of their ends' bounds.
    const double bulge = std::max(north - south, east - west) * 0.3 + marginDeg * 0.02;
    const bool anywhere = std::max(std::abs(south), std::abs(north)) > 75.0;
    const size_t rowEnd = anywhere ? kBins - 1 : binOf(north + bulge, south_, north_);
    const size_t columnEnd = anywhere ? kBins - 1 : binOf(east + bulge, west_, east_);
    for (size_t r = anywhere ? 0 : binOf(south - bulge, south_, north_); r <= rowEnd; ++r) {
      for (size_t c = anywhere ? 0 : binOf(west - bulge, west_, east_); c <= columnEnd; ++c) {
        bins_[r * kBins + c].push_back(static_cast<uint32_t>(t));
      }
    }
  }
}

size_t MeshProbe::binOf(double value, double low, double high) const {
  const double bin = (value - low) / (high - low) * static_cast<double>(kBins);
  return static_cast<size_t>(std::clamp(bin, 0.0, static_cast<double>(kBins - 1)));
}

std::optional<ProbeHit> MeshProbe::probe(double latDeg, double lonDeg, double heightM) const {
  const Vec3d from = ecefFromGeodetic({latDeg, lonDeg, heightM}), up = upAt(latDeg, lonDeg);
  double lowest = 1e300, highest = -1e300;
  for (const uint32_t t : bins_[binOf(latDeg, south_, north_) * kBins + binOf(lonDeg, west_, east_)]) {
    // Moller & Trumbore (1997), relative to the ray's start.
    const Vec3d a = positions_[indices_[3 * t]] - from;
    const Vec3d ab = positions_[indices_[3 * t + 1]] - from - a, ac = positions_[indices_[3 * t + 2]] - from - a;
    const Vec3d p = glm::cross(up, ac);
    const double determinant = glm::dot(ab, p);
    if (determinant == 0.0) continue;
    const double u = -glm::dot(a, p) / determinant;
    const Vec3d q = glm::cross(-a, ab);
    const double v = glm::dot(up, q) / determinant;
    constexpr double kRim = -1e-9;
    if (u < kRim || v < kRim || u + v > 1.0 - kRim) continue;
    const double distance = glm::dot(ac, q) / determinant;
    lowest = std::min(lowest, distance);
    highest = std::max(highest, distance);
  }
  if (lowest > highest) return std::nullopt;
  return ProbeHit{std::abs(lowest) > std::abs(highest) ? lowest : highest, highest - lowest};
}

}  // namespace eye::test
