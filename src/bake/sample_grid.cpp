#include "bake/sample_grid.h"

#include <algorithm>
#include <cmath>

#include "bake/tile_frame.h"

namespace eye {
namespace {

// Near a pole a cell is a wedge, however short: its longitudes are cut at least so fine.
constexpr double kMaxLonGapDeg = 90.0 / 32.0;
// Post lines may be missing in part of a block: a source ends there. A gap of so many spacings is then filled.
constexpr double kGapSpacings = 1.5;

// Ascending lines from `low` to `high` through all of `posts`, no gap wider than `maxGap`.
void makeLines(double low, double high, const std::vector<double>& posts, double maxGap, std::vector<double>& lines) {
  lines.assign(1, low);
  const auto extendTo = [&](double to) {
    const double from = lines.back();
    const int parts = static_cast<int>(std::ceil((to - from) / maxGap));
    for (int i = 1; i < parts; ++i) lines.push_back(from + (to - from) * i / parts);
    lines.push_back(to);
  };
  for (const double post : posts) {
    if (post > lines.back() && post < high) extendTo(post);
  }
  extendTo(high);
}

double widestGap(const std::vector<double>& lines) {
  double gap = 0;
  for (size_t i = 1; i < lines.size(); ++i) gap = std::max(gap, lines[i] - lines[i - 1]);
  return gap;
}

void cut(const ElevationSurface& surface, const TileBounds& r, double maxSide, std::vector<SampleBlock>& blocks) {
  const double spacingDeg = surface.finestSpacingDeg(r);
  const double heightDeg = r.northDeg - r.southDeg, widthDeg = r.eastDeg - r.westDeg;
  const bool cutLat = heightDeg > maxSide * spacingDeg, cutLon = widthDeg > maxSide * spacingDeg;
  if (spacingDeg == 0 || (!cutLat && !cutLon)) {
    blocks.push_back({r, spacingDeg});
    return;
  }
  const double middleLat = cutLat ? (r.southDeg + r.northDeg) / 2.0 : r.northDeg;
  const double middleLon = cutLon ? (r.westDeg + r.eastDeg) / 2.0 : r.eastDeg;
  cut(surface, {r.southDeg, middleLat, r.westDeg, middleLon}, maxSide, blocks);
  if (cutLon) cut(surface, {r.southDeg, middleLat, middleLon, r.eastDeg}, maxSide, blocks);
  if (cutLat) cut(surface, {middleLat, r.northDeg, r.westDeg, middleLon}, maxSide, blocks);
  if (cutLat && cutLon) cut(surface, {middleLat, r.northDeg, middleLon, r.eastDeg}, maxSide, blocks);
}

}  // namespace

std::vector<SampleBlock> planBlocks(const ElevationSurface& surface, const TileBounds& region, double maxSide) {
  std::vector<SampleBlock> blocks;
  cut(surface, region, maxSide, blocks);
  return blocks;
}

void fillGrid(const ElevationSurface& surface, const SampleBlock& block, double maxBendM, SampleGrid& grid) {
  const TileBounds& r = block.region;
  // A square cell of side a bends by its diagonal's sagitta, 2 a^2 / 8R.
  const double maxSideDeg = degFromRad(std::sqrt(4.0 * maxBendM / kSemiMajorM));
  const double southCos = std::cos(radFromDeg(r.southDeg)), northCos = std::cos(radFromDeg(r.northDeg));
  const double widestCos = r.southDeg < 0 && r.northDeg > 0 ? 1.0 : std::max(southCos, northCos);
  double maxLatGap = maxSideDeg, maxLonGap = std::min(maxSideDeg / std::max(widestCos, 1e-6), kMaxLonGapDeg);
  PostLines posts;
  if (block.spacingDeg > 0) {
    posts = surface.postLines(r);
    maxLatGap = std::min(maxLatGap, kGapSpacings * std::max(block.spacingDeg, widestGap(posts.latDeg)));
    maxLonGap = std::min(maxLonGap, kGapSpacings * std::max(block.spacingDeg, widestGap(posts.lonDeg)));
  }
  makeLines(r.southDeg, r.northDeg, posts.latDeg, maxLatGap, grid.latDeg);
  makeLines(r.westDeg, r.eastDeg, posts.lonDeg, maxLonGap, grid.lonDeg);

  const double heightM = radFromDeg(widestGap(grid.latDeg)) * kSemiMajorM;
  const double widthM = radFromDeg(widestGap(grid.lonDeg)) * kSemiMajorM * widestCos;
  grid.bendM = (heightM * heightM + widthM * widthM) / (8.0 * kSemiMinorM);

  grid.curvature.clear();
  for (const double latDeg : grid.latDeg) {
    const Parallel p = parallelAt(latDeg);
    grid.curvature.push_back({meridianRadiusM(p.sinLat), p.primeVerticalM, p.sinLat, p.cosLat});
  }
  thread_local std::vector<LatLon> places;
  places.clear();
  for (const double latDeg : grid.latDeg) {
    for (const double lonDeg : grid.lonDeg) places.push_back({latDeg, lonDeg});
  }
  surface.heightsM(places, grid.heightM);
}

}  // namespace eye
