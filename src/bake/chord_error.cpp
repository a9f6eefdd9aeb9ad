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

class Measure {
 public:
  Measure(const SampleGrid& grid, double toleranceM, ChordError& worst)
      : grid_(grid), toleranceM_(toleranceM), worst_(worst) {}

  void chord(const ChordEnd& a, const ChordEnd& b, int cutsLeft) {
    // Second-order terms of a straight line in geodetic coordinates, from the equations of a geodesic and of its
    // height; the third order is what limits the length.
    const double middleLat = radFromDeg((a.latDeg + b.latDeg) / 2.0);
    const double sinLat = std::sin(middleLat), cosLat = std::cos(middleLat);
    const double meridianM = meridianRadiusM(sinLat), primeM = primeVerticalRadiusM(sinLat);
    const double dLat = radFromDeg(b.latDeg - a.latDeg), dLon = radFromDeg(b.lonDeg - a.lonDeg);
    const double northM = meridianM * dLat, eastM = primeM * cosLat * dLon;
    const double length2 = northM * northM + eastM * eastM;
    const double tanLat = std::abs(sinLat) / cosLat;
    const double thirdOrderM =
        length2 * std::sqrt(length2) * std::max(1.0, tanLat * tanLat) / (8.0 * kSemiMinorM * kSemiMinorM);
    if (thirdOrderM > toleranceM_ * 1e-3 && cutsLeft > 0) {
      cutInHalf(a, b, cutsLeft - 1);
      return;
    }
    const double climb = (b.altM - a.altM) / (4.0 * primeM);
    const double latRise = (primeM / meridianM) * sinLat * cosLat * dLon * dLon / 8.0 + climb * dLat;
    const double lonRise = -(meridianM / primeM) * (sinLat / cosLat) * dLat * dLon / 4.0 + climb * dLon;
    const double altRise = -(meridianM * dLat * dLat + primeM * cosLat * cosLat * dLon * dLon) / 8.0;
    lat_ = parabolaThrough(a.latDeg, b.latDeg, degFromRad(latRise));
    lon_ = parabolaThrough(a.lonDeg, b.lonDeg, degFromRad(lonRise));
    alt_ = parabolaThrough(a.altM, b.altM, altRise);
    overGrid();
  }

 private:
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
    const size_t row = cellOf(grid_.latDeg, latDeg), column = cellOf(grid_.lonDeg, lonDeg);
    const double atBegin = departure(begin, row, column), atMiddle = departure(middle, row, column);
    const double atEnd = departure(end, row, column);
    keep(atBegin, begin, row, column);
    keep(atMiddle, middle, row, column);
    keep(atEnd, end, row, column);
    const double curvature = atBegin - 2.0 * atMiddle + atEnd;
    const double u = 0.5 + (atBegin - atEnd) / (4.0 * curvature);
    if (u > 0.0 && u < 1.0) {
      const double extremum = begin + u * (end - begin);
      keep(departure(extremum, row, column), extremum, row, column);
    }
  }

  double surfaceM(double u, size_t row, size_t column) const {
    const double t = (lat_.at(u) - grid_.latDeg[row]) / (grid_.latDeg[row + 1] - grid_.latDeg[row]);
    const double s = (lon_.at(u) - grid_.lonDeg[column]) / (grid_.lonDeg[column + 1] - grid_.lonDeg[column]);
    const double south = grid_.at(row, column) + s * (grid_.at(row, column + 1) - grid_.at(row, column));
    const double north = grid_.at(row + 1, column) + s * (grid_.at(row + 1, column + 1) - grid_.at(row + 1, column));
    return south + t * (north - south);
  }

  double departure(double u, size_t row, size_t column) const { return surfaceM(u, row, column) - alt_.at(u); }

  void keep(double departureM, double u, size_t row, size_t column) {
    if (std::abs(departureM) <= worst_.errorM) return;
    worst_ = ChordError{std::abs(departureM), LatLon{lat_.at(u), lon_.at(u)}, surfaceM(u, row, column)};
  }

  const SampleGrid& grid_;
  double toleranceM_;
  ChordError& worst_;
  Parabola lat_, lon_, alt_;
};

}  // namespace

void findChordError(const SampleGrid& grid, const ChordEnd& a, const ChordEnd& b, double toleranceM,
                    ChordError& worst) {
  ChordEnd from = a, to = b;
  if (std::abs(from.latDeg) > kPoleDeg) from.lonDeg = to.lonDeg;
  if (std::abs(to.latDeg) > kPoleDeg) to.lonDeg = from.lonDeg;
  Measure(grid, toleranceM, worst).chord(from, to, kMaxCuts);
}

}  // namespace eye
