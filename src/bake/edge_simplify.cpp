#include "bake/edge_simplify.h"

#include <algorithm>
#include <cmath>

#include "bake/tile_frame.h"
#include "terrain/chunk.h"

namespace eye {
namespace {

// Half for what is seen above the curve; the rest is for the strip between curve and segment, and for rounding.
constexpr double kVerticalShare = 0.5;
constexpr double kHorizontalShare = 0.25;
// Of the tolerance: what the surface may differ above the segment itself before the segment is split.
constexpr double kAboveSegmentShare = 0.8;
// Below this share of the tolerance a horizontal deviation cannot matter on slopes up to 16 : 1.
constexpr double kNoticedHorizontalShare = 1.0 / 64.0;
// Half the width of the strip that a unit asks its post lines for: enough to meet a source that ends on the unit.
constexpr double kStripDeg = 1e-9;
// Units are asked for in parts of so many posts at most, so that a fine source somewhere along a long unit does not
// hide a coarser one elsewhere.
constexpr double kPostsPerPart = 512;
// Vertices closer than so many lattice steps could turn over when they are rounded.
constexpr double kMinGapSteps = 2.0;

struct Candidate {
  double alongDeg = 0;
  EdgePoint point;
  Vec3d roundedEcefM{};  // on the lattice, as it will be drawn
  Vec3d up{};
};

class UnitCurve {
 public:
  UnitCurve(const ElevationSurface& surface, const EdgeUnit& unit, double stepM)
      : surface_(surface), unit_(unit), stepM_(stepM), isParallel_(unit.from.latDeg == unit.to.latDeg) {}

  bool isParallel() const { return isParallel_; }
  double beginDeg() const { return isParallel_ ? unit_.from.lonDeg : unit_.from.latDeg; }
  double endDeg() const { return isParallel_ ? unit_.to.lonDeg : unit_.to.latDeg; }
  // Of the curve in space.
  double radiusM() const { return isParallel_ ? kSemiMajorM * std::cos(radFromDeg(unit_.from.latDeg)) : kSemiMinorM; }

  Candidate at(double alongDeg) const {
    Candidate c;
    c.alongDeg = alongDeg;
    c.point.place = isParallel_ ? LatLon{unit_.from.latDeg, alongDeg} : LatLon{alongDeg, unit_.from.lonDeg};
    const LatLon canonical = canonicalPlace(c.point.place);
    c.point.heightM = surface_.heightM(canonical.latDeg, canonical.lonDeg);
    c.point.ecefM = ecefFromGeodetic({canonical.latDeg, canonical.lonDeg, c.point.heightM});
    c.roundedEcefM = ecefFromLattice(latticeFromEcef(c.point.ecefM, stepM_), stepM_);
    c.up = upAt(canonical.latDeg, canonical.lonDeg);
    return c;
  }

  // The surface less the segment's height above a point of the segment that lies `offset` (ecef) from a candidate.
  double gapAboveSegmentM(const Candidate& c, const Vec3d& offset) const {
    LatLon p = canonicalPlace(c.point.place);
    const Mat3d axes = ecefFromEnu(p.latDeg, p.lonDeg);
    const double sinLat = std::sin(radFromDeg(p.latDeg)), cosLat = std::cos(radFromDeg(p.latDeg));
    p.latDeg = std::clamp(p.latDeg + degFromRad(glm::dot(axes[1], offset) / meridianRadiusM(sinLat)), -90.0, 90.0);
    p.lonDeg += degFromRad(glm::dot(axes[0], offset) / (primeVerticalRadiusM(sinLat) * std::max(cosLat, 1e-9)));
    p.lonDeg -= 360.0 * std::round(p.lonDeg / 360.0);
    return surface_.heightM(p.latDeg, p.lonDeg) - (c.point.heightM + glm::dot(axes[2], offset));
  }

  // Where the curve crosses post lines, ascending, inside (lowDeg, highDeg).
  void collectLines(double lowDeg, double highDeg, std::vector<double>& lines) const {
    const std::array<TileBounds, 2> strips = this->strips(lowDeg, highDeg);
    double spacingDeg = 0;
    for (const TileBounds& strip : strips) {
      const double spacing = surface_.finestSpacingDeg(strip);
      if (spacing > 0 && (spacingDeg == 0 || spacing < spacingDeg)) spacingDeg = spacing;
    }
    if (spacingDeg == 0) return;
    if (highDeg - lowDeg > kPostsPerPart * spacingDeg) {
      const double middle = (lowDeg + highDeg) / 2.0;
      collectLines(lowDeg, middle, lines);
      lines.push_back(middle);
      collectLines(middle, highDeg, lines);
      return;
    }
    const size_t first = lines.size();
    for (const TileBounds& strip : strips) {
      const PostLines posts = surface_.postLines(strip);
      const std::vector<double>& along = isParallel_ ? posts.lonDeg : posts.latDeg;
      lines.insert(lines.end(), along.begin(), along.end());
      if (!isOnDateLine()) break;
    }
    std::sort(lines.begin() + static_cast<std::ptrdiff_t>(first), lines.end());
  }

 private:
  bool isOnDateLine() const { return !isParallel_ && std::abs(unit_.from.lonDeg) == 180.0; }

  // The region about a part of the unit; at the date line one on either side, else the same twice.
  std::array<TileBounds, 2> strips(double lowDeg, double highDeg) const {
    if (isParallel_) {
      const double latDeg = unit_.from.latDeg;
      const TileBounds strip{std::max(latDeg - kStripDeg, -90.0), std::min(latDeg + kStripDeg, 90.0), lowDeg, highDeg};
      return {strip, strip};
    }
    if (isOnDateLine()) {
      return {TileBounds{lowDeg, highDeg, -180.0, -180.0 + kStripDeg},
              TileBounds{lowDeg, highDeg, 180.0 - kStripDeg, 180.0}};
    }
    const TileBounds strip{lowDeg, highDeg, unit_.from.lonDeg - kStripDeg, unit_.from.lonDeg + kStripDeg};
    return {strip, strip};
  }

  static LatLon canonicalPlace(LatLon p) {
    if (std::abs(p.latDeg) == 90.0) return LatLon{p.latDeg, 0.0};
    return LatLon{p.latDeg, p.lonDeg == -180.0 ? 180.0 : p.lonDeg};
  }

  const ElevationSurface& surface_;
  EdgeUnit unit_;
  double stepM_;
  bool isParallel_;
};

// Ends, post crossings, and where these are far apart enough points between that the Earth's curvature is seen.
std::vector<Candidate> collectCandidates(const UnitCurve& curve, double toleranceM, double minGapDeg) {
  std::vector<double> lines;
  curve.collectLines(curve.beginDeg(), curve.endDeg(), lines);
  const double metresPerDeg = radFromDeg(curve.radiusM());
  // An arc of length s rises s^2 / 8r above its chord; a sixteenth of the tolerance goes unseen.
  const double maxGapDeg = std::max(std::sqrt(toleranceM * curve.radiusM() / 2.0) / metresPerDeg, minGapDeg);

  std::vector<Candidate> candidates{curve.at(curve.beginDeg())};
  const auto fillTo = [&](double alongDeg) {
    const double fromDeg = candidates.back().alongDeg;
    const int parts = static_cast<int>(std::ceil((alongDeg - fromDeg) / maxGapDeg));
    for (int i = 1; i < parts; ++i) candidates.push_back(curve.at(fromDeg + (alongDeg - fromDeg) * i / parts));
  };
  for (const double line : lines) {
    if (line <= candidates.back().alongDeg || line >= curve.endDeg()) continue;
    fillTo(line);
    candidates.push_back(curve.at(line));
  }
  fillTo(curve.endDeg());
  candidates.push_back(curve.at(curve.endDeg()));
  return candidates;
}

// From a candidate to the point of the segment a-b beside it.
Vec3d offsetToSegment(const Candidate& a, const Candidate& b, const Candidate& c) {
  const Vec3d along = b.roundedEcefM - a.roundedEcefM;
  const Vec3d level = along - glm::dot(along, c.up) * c.up;
  const double share = glm::dot(c.point.ecefM - a.roundedEcefM, level) / glm::dot(along, level);
  return a.roundedEcefM + std::clamp(share, 0.0, 1.0) * along - c.point.ecefM;
}

// The candidate between two that calls for a split, or `first` where none does.
size_t findSplit(const UnitCurve& curve, const std::vector<Candidate>& candidates, size_t first, size_t last,
                 double toleranceM, double minGapDeg) {
  const Candidate &a = candidates[first], &b = candidates[last];
  size_t split = first;
  double worst = 1.0, widest = 0.0;  // shares of what is allowed
  const auto consider = [&](size_t i, double share) {
    const double alongDeg = candidates[i].alongDeg;
    if (share <= worst || alongDeg - a.alongDeg < minGapDeg || b.alongDeg - alongDeg < minGapDeg) return;
    worst = share;
    split = i;
  };
  for (size_t i = first + 1; i < last; ++i) {
    const Vec3d offset = offsetToSegment(a, b, candidates[i]);
    const double vertical = glm::dot(offset, candidates[i].up);
    const double horizontal = glm::length(offset - vertical * candidates[i].up);
    widest = std::max(widest, horizontal);
    consider(i, std::max(std::abs(vertical) / kVerticalShare, horizontal / kHorizontalShare) / toleranceM);
  }
  if (split != first || widest < kNoticedHorizontalShare * toleranceM) return split;
  for (size_t i = first + 1; i < last; ++i) {
    const Vec3d offset = offsetToSegment(a, b, candidates[i]);
    consider(i, std::abs(curve.gapAboveSegmentM(candidates[i], offset)) / (kAboveSegmentShare * toleranceM));
  }
  return split;
}

}  // namespace

// Ramer (1972), Douglas & Peucker (1973).
std::vector<EdgePoint> simplifyEdge(const ElevationSurface& surface, const EdgeUnit& unit, double toleranceM,
                                    double stepM) {
  const UnitCurve curve(surface, unit, stepM);
  const double minGapDeg = kMinGapSteps * stepM / radFromDeg(curve.radiusM());
  const std::vector<Candidate> candidates = collectCandidates(curve, toleranceM, minGapDeg);
  std::vector<EdgePoint> kept{candidates.front().point};
  std::vector<size_t> ends{candidates.size() - 1};  // of segments still to be looked at, the next one last
  size_t first = 0;
  while (!ends.empty()) {
    const size_t last = ends.back();
    const size_t split = findSplit(curve, candidates, first, last, toleranceM, minGapDeg);
    if (split != first) {
      ends.push_back(split);
      continue;
    }
    kept.push_back(candidates[last].point);
    first = last;
    ends.pop_back();
  }
  return kept;
}

TileBoundary makeBoundary(const ElevationSurface& surface, const TileKey& key, const TileTolerance& toleranceM,
                          double stepM) {
  const TileBounds b = key.bounds();
  const Side poleward = key.isSouthern() ? Side::south : Side::north;
  const double ownToleranceM = toleranceM(key);
  TileBoundary boundary;
  for (size_t i = 0; i < kSides.size(); ++i) {
    const Side side = kSides[i];
    if (key.isPolar() && side == poleward) continue;  // a point
    const TileList<2> across = key.neighbours(side);
    std::vector<EdgeUnit> units;
    if (side == Side::east || side == Side::west) {
      const double lonDeg = side == Side::east ? b.eastDeg : b.westDeg;
      units.push_back({{b.southDeg, lonDeg}, {b.northDeg, lonDeg}});
    } else {
      const double latDeg = side == Side::south ? b.southDeg : b.northDeg;
      const double middleDeg = (b.westDeg + b.eastDeg) / 2.0;
      if (across.count == 2) {
        units.push_back({{latDeg, b.westDeg}, {latDeg, middleDeg}});
        units.push_back({{latDeg, middleDeg}, {latDeg, b.eastDeg}});
      } else {
        units.push_back({{latDeg, b.westDeg}, {latDeg, b.eastDeg}});
      }
    }
    std::vector<EdgePoint> points;
    for (size_t u = 0; u < units.size(); ++u) {
      const double unitToleranceM = std::min(ownToleranceM, toleranceM(across.items[u]));
      const std::vector<EdgePoint> part = simplifyEdge(surface, units[u], unitToleranceM, stepM);
      points.insert(points.end(), part.begin() + (points.empty() ? 0 : 1), part.end());
    }
    if (side == Side::north || side == Side::west) std::reverse(points.begin(), points.end());
    boundary.counts[i] = static_cast<uint16_t>(points.size() - 1);
    boundary.loop.insert(boundary.loop.end(), points.begin(), points.end() - 1);
  }
  return boundary;
}

}  // namespace eye
