#include "bake/chord_error.h"

#include <algorithm>
#include <cmath>

#include "bake/tile_frame.h"

namespace eye {
namespace {

constexpr int kMaxCuts = 14;
// How far outside the grid a chord may lie and still be measured against its border: rounded border vertices do.
constexpr double kOutsideDeg = 1e-6;
constexpr double kPoleDeg = 90.0 - 1e-9;

// c0 + c1 u + c2 u^2 for u in [0, 1] along the chord.
struct Parabola {
  double c0 = 0, c1 = 0, c2 = 0;
  double at(double u) const { return c0 + u * (c1 + u * c2); }
};

// Through both ends, with a rise over their mean in the middle.
Parabola parabolaThrough(double begin, double end, double middleRise) {
  return Parabola{begin, end - begin + 4.0 * middleRise, -4.0 * middleRise};
}

struct Range {
  double low, high;
};
Range rangeOf(const Parabola& p) {
  Range r{std::min(p.c0, p.at(1.0)), std::max(p.c0, p.at(1.0))};
  const double u = -p.c1 / (2.0 * p.c2);
  if (u > 0.0 && u < 1.0) r = {std::min(r.low, p.at(u)), std::max(r.high, p.at(u))};
  return r;
}

// The cell whose lines enclose a value, clamped to the grid.
size_t cellOf(const std::vector<double>& lines, double value) {
  // Lines are nearly even: a guess, then steps.
  const double share = (value - lines.front()) / (lines.back() - lines.front());
  const size_t last = lines.size() - 2;
  size_t i =
      static_cast<size_t>(std::clamp(share * static_cast<double>(lines.size() - 1), 0.0, static_cast<double>(last)));
  while (i > 0 && value < lines[i]) --i;
  while (i < last && value >= lines[i + 1]) ++i;
  return i;
}

void addCrossings(const std::vector<double>& lines, const Parabola& p, std::vector<double>& cuts) {
  const Range range = rangeOf(p);
  if (range.high < lines.front() || range.low > lines.back()) return;
  for (size_t i = cellOf(lines, range.low); i < lines.size() && lines[i] <= range.high; ++i) {
    if (lines[i] < range.low) continue;
    // c2 u^2 + c1 u + (c0 - line) = 0, without cancellation.
    const double c = p.c0 - lines[i], discriminant = p.c1 * p.c1 - 4.0 * p.c2 * c;
    if (discriminant < 0.0) continue;
    const double q = -0.5 * (p.c1 + std::copysign(std::sqrt(discriminant), p.c1));
    for (const double u : {c / q, q / p.c2}) {
      if (u > 0.0 && u < 1.0) cuts.push_back(u);
    }
  }
}

// Whether a chord certainly misses the grid, told cheaply. False near a pole, where lines bend at will.
bool passesBeside(const SampleGrid& grid, const ChordEnd& a, const ChordEnd& b) {
  const double dLat = b.latDeg - a.latDeg, dLon = b.lonDeg - a.lonDeg;
  if (std::max(std::abs(a.latDeg), std::abs(b.latDeg)) > 75.0) return false;
  // The bulge in radians is below (dLat^2 + dLon^2) tan(lat) / 8, and tan 75 < 4.
  const double bulgeDeg = radFromDeg(dLat * dLat + dLon * dLon) + kOutsideDeg;
  return std::max(a.latDeg, b.latDeg) + bulgeDeg < grid.latDeg.front() ||
         std::min(a.latDeg, b.latDeg) - bulgeDeg > grid.latDeg.back() ||
         std::max(a.lonDeg, b.lonDeg) + bulgeDeg < grid.lonDeg.front() ||
         std::min(a.lonDeg, b.lonDeg) - bulgeDeg > grid.lonDeg.back();
}

class Measure {
 public:
  Measure(const SampleGrid& grid, double toleranceM, ChordError& worst)
      : grid_(grid), toleranceM_(toleranceM), worst_(worst) {}

  void chord(const ChordEnd& a, const ChordEnd& b, int cutsLeft) {
    // Second-order terms of a straight line in geodetic coordinates, from the equations of a geodesic and of its
    // height; the third order is what limits the length. Within a row the radii hardly change.
    const double middleLatDeg = (a.latDeg + b.latDeg) / 2.0;
    const SampleGrid::Curvature at = curvatureAt(middleLatDeg);
    const double dLat = radFromDeg(b.latDeg - a.latDeg), dLon = radFromDeg(b.lonDeg - a.lonDeg);
    const double north2 = at.meridianM * dLat * dLat, east2 = at.primeM * at.cosLat * at.cosLat * dLon * dLon;
    const double length2 = (north2 + east2) * kSemiMajorM, tanLat = at.sinLat / at.cosLat;
    const double thirdOrder = length2 * std::max(1.0, tanLat * tanLat) / (8.0 * kSemiMinorM * kSemiMinorM);
    if (thirdOrder * thirdOrder * length2 > toleranceM_ * toleranceM_ * 1e-6 && cutsLeft > 0) {
      cutInHalf(a, b, cutsLeft - 1);
      return;
    }
    const double climb = (b.altM - a.altM) / (4.0 * at.primeM), ratio = at.primeM / at.meridianM;
    const double latRise = ratio * at.sinLat * at.cosLat * dLon * dLon / 8.0 + climb * dLat;
    const double lonRise = -tanLat / ratio * dLat * dLon / 4.0 + climb * dLon;
    const double altRise = -(north2 + east2) / 8.0;
    lat_ = parabolaThrough(a.latDeg, b.latDeg, degFromRad(latRise));
    lon_ = parabolaThrough(a.lonDeg, b.lonDeg, degFromRad(lonRise));
    alt_ = parabolaThrough(a.altM, b.altM, altRise);
    overGrid();
  }

 private:
  SampleGrid::Curvature curvatureAt(double latDeg) const {
    if (latDeg >= grid_.latDeg.front() && latDeg <= grid_.latDeg.back()) {
      // At the row's side towards the equator: at a pole itself longitudes turn without end.
      return grid_.curvature[cellOf(grid_.latDeg, latDeg) + (latDeg < 0 ? 1 : 0)];
    }
    const Parallel p = parallelAt(latDeg);
    return {meridianRadiusM(p.sinLat), p.primeVerticalM, p.sinLat, p.cosLat};
  }

  void cutInHalf(ChordEnd a, ChordEnd b, int cutsLeft) {
    // At a pole itself the longitude is the other end's.
    if (std::abs(a.latDeg) > kPoleDeg) a.lonDeg = b.lonDeg;
    if (std::abs(b.latDeg) > kPoleDeg) b.lonDeg = a.lonDeg;
    const Geodetic g = geodeticFromEcef(
        (ecefFromGeodetic({a.latDeg, a.lonDeg, a.altM}) + ecefFromGeodetic({b.latDeg, b.lonDeg, b.altM})) / 2.0);
    const double turns = std::round((g.lonDeg - (a.lonDeg + b.lonDeg) / 2.0) / 360.0);
    const ChordEnd middle{g.latDeg, g.lonDeg - 360.0 * turns, g.altM};
    chord(a, middle, cutsLeft);
    chord(middle, b, cutsLeft);
  }

  void overGrid() {
    const Range lat = rangeOf(lat_), lon = rangeOf(lon_);
    if (lat.high < grid_.latDeg.front() - kOutsideDeg || lat.low > grid_.latDeg.back() + kOutsideDeg ||
        lon.high < grid_.lonDeg.front() - kOutsideDeg || lon.low > grid_.lonDeg.back() + kOutsideDeg) {
      return;
    }
    thread_local std::vector<double> cuts;
    cuts.assign({0.0, 1.0});
    addCrossings(grid_.latDeg, lat_, cuts);
    addCrossings(grid_.lonDeg, lon_, cuts);
    if (cuts.size() > 2) std::sort(cuts.begin(), cuts.end());
    for (size_t i = 0; i + 1 < cuts.size(); ++i) {
      if (cuts[i + 1] > cuts[i]) between(cuts[i], cuts[i + 1]);
    }
  }

  void between(double begin, double end) {
    const double middle = (begin + end) / 2.0;
    const double latDeg = lat_.at(middle), lonDeg = lon_.at(middle);
    if (latDeg < grid_.latDeg.front() - kOutsideDeg || latDeg > grid_.latDeg.back() + kOutsideDeg ||
        lonDeg < grid_.lonDeg.front() - kOutsideDeg || lonDeg > grid_.lonDeg.back() + kOutsideDeg) {
      return;
    }
    setCell(cellOf(grid_.latDeg, latDeg), cellOf(grid_.lonDeg, lonDeg));
    const double atBegin = departure(begin), atMiddle = departure(middle), atEnd = departure(end);
    keep(atBegin, begin);
    keep(atMiddle, middle);
    keep(atEnd, end);
    const double u = 0.5 + (atBegin - atEnd) / (4.0 * (atBegin - 2.0 * atMiddle + atEnd));
    if (u > 0.0 && u < 1.0) {
      const double extremum = begin + u * (end - begin);
      keep(departure(extremum), extremum);
    }
  }

  void setCell(size_t row, size_t column) {
    cellLat_ = grid_.latDeg[row];
    cellLon_ = grid_.lonDeg[column];
    const double perLat = 1.0 / (grid_.latDeg[row + 1] - cellLat_),
                 perLon = 1.0 / (grid_.lonDeg[column + 1] - cellLon_);
    const double sw = grid_.at(row, column), se = grid_.at(row, column + 1);
    const double nw = grid_.at(row + 1, column), ne = grid_.at(row + 1, column + 1);
    cornerM_ = sw;
    slopeLat_ = (nw - sw) * perLat;
    slopeLon_ = (se - sw) * perLon;
    twist_ = (sw + ne - se - nw) * perLat * perLon;
  }

  double surfaceM(double u) const {
    const double lat = lat_.at(u) - cellLat_, lon = lon_.at(u) - cellLon_;
    return cornerM_ + slopeLat_ * lat + (slopeLon_ + twist_ * lat) * lon;
  }

  double departure(double u) const { return surfaceM(u) - alt_.at(u); }

  void keep(double departureM, double u) {
    if (std::abs(departureM) <= worst_.errorM) return;
    worst_ = ChordError{std::abs(departureM), LatLon{lat_.at(u), lon_.at(u)}, surfaceM(u)};
  }

  const SampleGrid& grid_;
  double toleranceM_;
  ChordError& worst_;
  Parabola lat_, lon_, alt_;
  // The bilinear cell at hand, from its south-west corner.
  double cellLat_ = 0, cellLon_ = 0, cornerM_ = 0, slopeLat_ = 0, slopeLon_ = 0, twist_ = 0;
};

}  // namespace

void findChordError(const SampleGrid& grid, const ChordEnd& a, const ChordEnd& b, double toleranceM,
                    ChordError& worst) {
  if (passesBeside(grid, a, b)) return;
  ChordEnd from = a, to = b;
  if (std::abs(from.latDeg) > kPoleDeg) from.lonDeg = to.lonDeg;
  if (std::abs(to.latDeg) > kPoleDeg) to.lonDeg = from.lonDeg;
  Measure(grid, toleranceM, worst).chord(from, to, kMaxCuts);
}

}  // namespace eye
