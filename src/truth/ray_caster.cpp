#include "truth/ray_caster.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <thread>

namespace eye::truth {
namespace {

constexpr double kMaxStepM = 10000;  // a ray bends by less than 10 m in the grid along that, an eighth of a cell
constexpr double kMinStepM = 1e-3;   // over a cell's border, so that the march goes on
constexpr double kRootM = 1e-4;      // to which a hit is polished
constexpr double kFringePosts = 17;  // around the source, where its edge fades to the sea (16 posts, and one to spare)

// A place on the ray: grid coordinates and how they and the altitude change per metre.
struct Sample {
  double row, column, altM;
  double rowRate, columnRate, altRate;
};

struct Ray {
  const HeightGrid& grid;
  Vec eye, direction;

  Sample at(double t) const {
    const LocalFrame f = frameAt(eye + t * direction);
    const double step = grid.shape().stepDeg;
    return {grid.rowOf(f.place.latDeg),
            grid.columnOf(f.place.lonDeg),
            f.place.altM,
            dot(direction, f.north) / (f.metresPerDegLat * step),
            dot(direction, f.east) / (f.metresPerDegLon * step),
            dot(direction, f.up)};
  }
  double clearanceM(double t) const {
    const Sample s = at(t);
    return s.altM - grid.heightM(s.row, s.column);
  }
};

// Metres to where the ray leaves the rectangle of grid coordinates that it is in.
double exitM(const Sample& s, double south, double north, double west, double east) {
  double exit = std::numeric_limits<double>::infinity();
  if (s.rowRate > 0) exit = std::min(exit, (north - s.row) / s.rowRate);
  if (s.rowRate < 0) exit = std::min(exit, (south - s.row) / s.rowRate);
  if (s.columnRate > 0) exit = std::min(exit, (east - s.column) / s.columnRate);
  if (s.columnRate < 0) exit = std::min(exit, (west - s.column) / s.columnRate);
  return std::max(exit, 0.0);
}

// The root of the clearance between a (above) and b (below): the secant with bisection where it stalls (Illinois).
double polish(const Ray& ray, double a, double clearA, double b, double clearB) {
  while (b - a > kRootM) {
    double t = a + (b - a) * clearA / (clearA - clearB);
    t = std::clamp(t, a + 0.1 * kRootM, b - 0.1 * kRootM);
    const double clear = ray.clearanceM(t);
    if (clear > 0) {
      if (b - t < kRootM) return b;
      a = t;
      clearA = clear;
      clearB /= 2;
    } else {
      if (t - a < kRootM) return t;
      b = t;
      clearB = clear;
      clearA /= 2;
    }
  }
  return b;
}

// The first hit within one cell. The clearance is a quadratic there but for the Earth's curvature over a cell, so three
// samples find the piece that holds its first root.
std::optional<double> hitInCell(const Ray& ray, double a, double b) {
  const double mid = (a + b) / 2;
  const double clearA = ray.clearanceM(a), clearMid = ray.clearanceM(mid), clearB = ray.clearanceM(b);
  if (clearA <= 0) return a;
  if (clearMid <= 0) return polish(ray, a, clearA, mid, clearMid);
  // Lowest point of the parabola through the three, in [0, 1].
  const double bend = 2 * (clearA + clearB - 2 * clearMid), slope = 4 * clearMid - 3 * clearA - clearB;
  if (bend > 0) {
    const double lowest = -slope / (2 * bend);
    if (lowest > 0 && lowest < 1) {
      const double t = a + lowest * (b - a), clear = ray.clearanceM(t);
      if (clear <= 0) return polish(ray, a, clearA, t, clear);
    }
  }
  if (clearB <= 0) return polish(ray, mid, clearMid, b, clearB);
  return {};
}

// The rest of a ray that leaves the source at t: over the fringe, then down to the sea or off into the sky.
Hit beyondSource(const Ray& ray, double t) {
  const Sample s = ray.at(t);
  const GridShape& shape = ray.grid.shape();
  const double fringe =
      exitM(s, -kFringePosts, shape.rows - 1 + kFringePosts, -kFringePosts, shape.columns - 1 + kFringePosts);
  // Altitude along a straight line is convex (a distance to a convex body), so its tangent bounds it from below.
  const double lowestM = s.altM + std::min(0.0, s.altRate) * std::min(fringe, 1e6);
  if (lowestM < std::max(0.0f, ray.grid.highestBorderPostM())) return {HitKind::unknown, 0};
  double a = t + fringe;
  if (!std::isfinite(a)) return {HitKind::sky, 0};
  // Newton from outside of a convex function never steps past its first root.
  for (int i = 0; i < 100; ++i) {
    const Sample over = ray.at(a);
    if (over.altRate >= 0) return {HitKind::sky, 0};
    if (over.altM < 1e-4) return {HitKind::terrain, a};
    a += over.altM / -over.altRate;
  }
  return {HitKind::unknown, 0};  // grazes the sea
}

}  // namespace

Hit castRay(const HeightGrid& grid, Vec eyeEcefM, Vec directionEcef) {
  const Ray ray{grid, eyeEcefM, (1 / length(directionEcef)) * directionEcef};
  const int lastRow = grid.shape().rows - 2, lastColumn = grid.shape().columns - 2;  // of cells
  const int top = grid.levels() - 1;
  int level = top;
  double t = 0;
  while (true) {
    const Sample s = ray.at(t);
    const auto row = static_cast<int>(std::floor(s.row)), column = static_cast<int>(std::floor(s.column));
    if (row < 0 || column < 0 || row > lastRow || column > lastColumn) return beyondSource(ray, t);
    if (s.altRate >= 0 && s.altM > grid.highestPostM()) return {HitKind::sky, 0};
    for (;; --level) {
      const int south = row >> level << level, west = column >> level << level, size = 1 << level;
      const double exit = std::min(exitM(s, south, south + size, west, west + size), kMaxStepM) + kMinStepM;
      const double highestM = grid.highestM(level, row >> level, column >> level);
      if (s.altM + std::min(0.0, s.altRate) * exit > highestM) {
        t += exit;
        level = std::min(level + 1, top);
        break;
      }
      const double descentM = s.altRate < 0 ? (s.altM - highestM) / -s.altRate : 0;
      if (descentM > exit / 2) {  // most of the block is free
        t += descentM;
        break;
      }
      if (level > 0) continue;
      if (std::isnan(grid.heightM(row + 0.5, column + 0.5))) return {HitKind::unknown, 0};
      if (const auto hit = hitInCell(ray, t, t + exit)) return {HitKind::terrain, *hit};
      t += exit;
      break;
    }
  }
}

TruthImage castImage(const HeightGrid& grid, const EyePose& pose, double fovDeg, int widthPx, int heightPx) {
  TruthImage image{widthPx, heightPx, {}};
  image.hits.resize(static_cast<size_t>(widthPx + 2) * static_cast<size_t>(heightPx + 2));
  const Vec eye = ecefFromPlace(pose.at);
  const EyeAxes axes = axesOf(pose);
  const double pixel = 2 * std::tan(fovDeg / 2 / 57.29577951308232) / widthPx;  // tangent a pixel
  const auto castRows = [&](int first, int step) {
    for (int row = first; row < heightPx + 2; row += step) {
      for (int column = 0; column < widthPx + 2; ++column) {
        const double right = (column - 1 + 0.5 - widthPx / 2.0) * pixel,
                     up = (heightPx / 2.0 - (row - 1 + 0.5)) * pixel;
        image.hits[static_cast<size_t>(row) * static_cast<size_t>(widthPx + 2) + static_cast<size_t>(column)] =
            castRay(grid, eye, axes.forward + right * axes.right + up * axes.up);
      }
    }
  };
  const int threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  std::vector<std::jthread> workers;
  for (int i = 1; i < threads; ++i) workers.emplace_back(castRows, i, threads);
  castRows(0, threads);
  return image;
}

}  // namespace eye::truth
