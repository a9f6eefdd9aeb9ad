#include "bake/elevation_layer.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace eye {

namespace {

struct DegreeRect {
  double southDeg, northDeg, westDeg, eastDeg;
};

DegreeRect degreesOf(const GeoGrid& grid, double marginPosts) {
  return {grid.southDeg - marginPosts * grid.latStepDeg, grid.northDeg() + marginPosts * grid.latStepDeg,
          grid.westDeg - marginPosts * grid.lonStepDeg, grid.eastDeg() + marginPosts * grid.lonStepDeg};
}

bool overlaps(const DegreeRect& a, const TileBounds& b, double turnDeg) {
  return a.southDeg < b.northDeg && b.southDeg < a.northDeg && a.westDeg + turnDeg < b.eastDeg &&
         b.westDeg < a.eastDeg + turnDeg;
}

}  // namespace

std::vector<int64_t> ElevationLayer::turns() const {
  if (lattice_.turn == 0) return {0};
  return {-2 * lattice_.turn, -lattice_.turn, 0, lattice_.turn, 2 * lattice_.turn};
}

bool ElevationLayer::accepts(const GeoGrid& grid) const {
  const auto rect = rectOn(lattice_, grid);
  if (!rect) return false;
  for (const PostRect& other : rects_) {
    for (const int64_t turn : turns()) {
      PostRect moved = other;
      moved.west += turn;
      const PostRect common = intersect(*rect, moved);
      if (common.rows > 1 && common.columns > 1) return false;
    }
  }
  return true;
}

void ElevationLayer::add(ElevationFile file) {
  const PostRect rect = rectOn(lattice_, file.grid).value();
  if (rects_.empty()) bounds_ = rect;
  const int64_t north = std::max(bounds_.north(), rect.north()), east = std::max(bounds_.east(), rect.east());
  bounds_.south = std::min(bounds_.south, rect.south);
  bounds_.west = std::min(bounds_.west, rect.west);
  bounds_.rows = north - bounds_.south + 1;
  bounds_.columns = east - bounds_.west + 1;
  global_ = global_ || (lattice_.turn > 0 && rect.columns >= lattice_.turn);
  rects_.push_back(rect);
  files_.push_back(std::move(file));
}

Result<void> ElevationLayer::findPoles(const HeightCorrection& correctionM) {
  for (size_t i = 0; i < files_.size(); ++i) {
    const ElevationFile& file = files_[i];
    if (lattice_.turn == 0 || file.grid.columns < lattice_.turn) continue;
    for (const bool north : {true, false}) {
      const double lastDeg = north ? file.grid.northDeg() : file.grid.southDeg;
      if (90 - std::abs(lastDeg) > 1.01 * file.grid.latStepDeg) continue;
      std::vector<float> row(static_cast<size_t>(file.grid.columns));
      const Result<void> read = readPosts(file, north ? 0 : file.grid.rows - 1, 0, 1, file.grid.columns, row.data());
      if (!read) return read;
      double sum = 0;
      int count = 0;
      for (const float height : row) {
        if (std::isnan(height)) continue;
        sum += static_cast<double>(height);
        ++count;
      }
      if (count == 0) continue;
      (north ? northPoleM_ : southPoleM_) = sum / count + (correctionM ? correctionM(north ? 90 : -90, 0) : 0);
      (north ? hasNorthPole_ : hasSouthPole_) = true;
    }
  }
  return {};
}

bool ElevationLayer::locate(double latDeg, double lonDeg, Place& place) const {
  double row = lattice_.lat.position(latDeg);
  double column = lattice_.lon.position(lonDeg);
  const auto turn = static_cast<double>(lattice_.turn);
  if (lattice_.turn > 0) {
    if (column < 0) column += turn;
    if (column >= turn) column -= turn;
  } else {
    // Without a whole number of columns around the globe, the turn that brings the point nearest the files.
    const double around = 360 * lattice_.lon.perDegree;
    const double middle = static_cast<double>(bounds_.west) + static_cast<double>(bounds_.columns) / 2;
    column -= around * std::round((column - middle) / around);
  }
  const auto south = static_cast<double>(bounds_.south), north = static_cast<double>(bounds_.north());
  place.poleShare = 0;
  if (hasNorthPole_ && row >= north) {
    const double pole = lattice_.lat.position(90);
    place.poleShare = pole - north < 1e-6 ? 1 : std::min((row - north) / (pole - north), 1.0);
    place.poleM = northPoleM_;
    row = north;
  } else if (hasSouthPole_ && row <= south) {
    const double pole = lattice_.lat.position(-90);
    place.poleShare = south - pole < 1e-6 ? 1 : std::min((south - row) / (south - pole), 1.0);
    place.poleM = southPoleM_;
    row = south;
  }
  if (row < south - kFadePosts || row > north + kFadePosts) return false;
  if (lattice_.turn == 0 && (column < static_cast<double>(bounds_.west) - kFadePosts ||
                             column > static_cast<double>(bounds_.east()) + kFadePosts)) {
    return false;
  }
  const double cellRow = std::floor(row), cellColumn = std::floor(column);
  place.row = static_cast<int64_t>(cellRow);
  place.column = static_cast<int64_t>(cellColumn);
  place.north = row - cellRow;
  place.east = column - cellColumn;
  return true;
}

Result<void> ElevationLayer::readFile(size_t index, int64_t shift, const PostRect& window, std::vector<float>& sum,
                                      std::vector<uint16_t>& count, std::vector<uint8_t>& isVoid) const {
  const ElevationFile& file = files_[index];
  PostRect rect = rects_[index];
  rect.west += shift;
  const PostRect part = intersect(rect, window);
  if (part.rows <= 0 || part.columns <= 0) return {};
  const auto firstRow = static_cast<int>(rect.north() - part.north());
  const auto firstColumn = static_cast<int>(part.west - rect.west);
  const auto rows = static_cast<int>(part.rows), columns = static_cast<int>(part.columns);
  std::vector<float> posts(static_cast<size_t>(rows) * static_cast<size_t>(columns));
  if (auto read = readPosts(file, firstRow, firstColumn, rows, columns, posts.data()); !read) return read;
  for (int row = 0; row < rows; ++row) {
    const int64_t target = (part.north() - row - window.south) * window.columns + part.west - window.west;
    for (int column = 0; column < columns; ++column) {
      const float height = posts[static_cast<size_t>(row) * static_cast<size_t>(columns) + static_cast<size_t>(column)];
      const auto at = static_cast<size_t>(target + column);
      if (std::isnan(height)) {
        if (!file.isCollar(firstRow + row, firstColumn + column)) isVoid[at] = 1;
      } else {
        sum[at] += height;
        ++count[at];
      }
    }
  }
  return {};
}

Result<ElevationPage> ElevationLayer::makePage(int64_t pageRow, int64_t pageColumn, const SurfaceBelow& below,
                                               const HeightCorrection& correctionM) const {
  ElevationPage page;
  page.south = pageRow * kPagePosts;
  page.west = pageColumn * kPagePosts;
  const int64_t posts = kPagePosts + 1;

  // Posts around the page are read as far as they bear on it, so that two pages agree on their common posts.
  constexpr int64_t kMargin = kFillPosts + kFadePosts;
  const PostRect window{page.south - kMargin, page.west - kMargin, posts + 2 * kMargin, posts + 2 * kMargin};
  const PostRect reach{page.south - kFadePosts, page.west - kFadePosts, posts + 2 * kFadePosts, posts + 2 * kFadePosts};
  bool within = false;
  for (const PostRect& rect : rects_) {
    for (const int64_t turn : turns()) {
      PostRect moved = rect;
      moved.west += turn;
      const PostRect common = intersect(moved, reach);
      within = within || (common.rows > 0 && common.columns > 0);
    }
  }
  if (!within) return page;  // without posts

  const auto count = static_cast<size_t>(window.rows * window.columns);
  std::vector<float> sum(count, 0.0f);
  std::vector<uint16_t> given(count, 0);
  std::vector<uint8_t> isVoid(count, 0);
  for (size_t i = 0; i < files_.size(); ++i) {
    for (const int64_t turn : turns()) {
      if (auto read = readFile(i, turn, window, sum, given, isVoid); !read) return tl::unexpected(read.error());
    }
  }
  PostWindow heights{static_cast<int>(window.rows), static_cast<int>(window.columns), std::move(sum)};
  const auto latOf = [&](size_t i) {
    return lattice_.lat.deg(window.south + static_cast<int64_t>(i) / window.columns);
  };
  const auto lonOf = [&](size_t i) {
    const double lon = lattice_.lon.deg(window.west + static_cast<int64_t>(i) % window.columns);
    return lon - 360 * std::floor((lon + 180) / 360);
  };
  bool anyVoid = false;
  for (size_t i = 0; i < count; ++i) {
    if (given[i] > 0) {
      heights.heightM[i] /= static_cast<float>(given[i]);
      if (correctionM) heights.heightM[i] += static_cast<float>(correctionM(latOf(i), lonOf(i)));
      isVoid[i] = 0;
    } else {
      heights.heightM[i] = std::numeric_limits<float>::quiet_NaN();
      // A void that a source below can fill is left to it.
      if (isVoid[i] && below(latOf(i), lonOf(i)).cover > 0.99) isVoid[i] = 0;
      anyVoid = anyVoid || isVoid[i];
    }
  }
  if (anyVoid) {
    if (auto filled = interpolateVoids(heights, std::move(isVoid)); !filled) return tl::unexpected(filled.error());
  }

  page.rows = page.columns = static_cast<int>(posts);
  page.heightM.resize(static_cast<size_t>(posts * posts));
  bool complete = true;
  for (int64_t row = 0; row < posts; ++row) {
    for (int64_t column = 0; column < posts; ++column) {
      const float height =
          heights.heightM[heights.index(static_cast<int>(row + kMargin), static_cast<int>(column + kMargin))];
      page.heightM[static_cast<size_t>(row * posts + column)] = height;
      complete = complete && !std::isnan(height);
    }
  }
  if (complete) return page;

  const Fade fade = fadeAround(heights);
  page.weight.resize(page.heightM.size());
  for (int64_t row = 0; row < posts; ++row) {
    for (int64_t column = 0; column < posts; ++column) {
      const size_t i = heights.index(static_cast<int>(row + kMargin), static_cast<int>(column + kMargin));
      const auto at = static_cast<size_t>(row * posts + column);
      page.weight[at] = fade.weight[i];
      if (!std::isnan(page.heightM[at])) continue;
      page.heightM[at] = 0;
      if (fade.nearest[i] < 0) continue;
      // The relief of the surface below, lifted by what the two differ at the nearest post of this layer.
      const auto near = static_cast<size_t>(fade.nearest[i]);
      const double liftM = static_cast<double>(heights.heightM[near]) - below(latOf(near), lonOf(near)).heightM;
      page.heightM[at] = static_cast<float>(below(latOf(i), lonOf(i)).heightM + liftM);
    }
  }
  return page;
}

bool ElevationLayer::meets(const TileBounds& region, int marginPosts) const {
  for (const ElevationFile& file : files_) {
    const DegreeRect rect = degreesOf(file.grid, marginPosts);
    for (const double turnDeg : {-720.0, -360.0, 0.0, 360.0}) {
      if (overlaps(rect, region, turnDeg)) return true;
    }
  }
  return false;
}

bool ElevationLayer::covers(const TileBounds& region) const {
  // The files' edges cut the region into rectangles; each must lie in a file. Half a post beyond the last row is still
  // the file's where another file of the lattice goes on.
  std::vector<DegreeRect> parts;
  std::vector<double> lats{region.southDeg, region.northDeg}, lons{region.westDeg, region.eastDeg};
  for (const ElevationFile& file : files_) {
    for (const double turnDeg : {-720.0, -360.0, 0.0, 360.0}) {
      DegreeRect rect = degreesOf(file.grid, 0.51);
      if (!overlaps(rect, region, turnDeg)) continue;
      rect.westDeg += turnDeg;
      rect.eastDeg += turnDeg;
      parts.push_back(rect);
      for (const double lat : {rect.southDeg, rect.northDeg}) {
        if (lat > region.southDeg && lat < region.northDeg) lats.push_back(lat);
      }
      for (const double lon : {rect.westDeg, rect.eastDeg}) {
        if (lon > region.westDeg && lon < region.eastDeg) lons.push_back(lon);
      }
    }
  }
  // Many files: the answer only saves work, so it may be no.
  if (parts.empty() || parts.size() > 64) return false;
  std::sort(lats.begin(), lats.end());
  std::sort(lons.begin(), lons.end());
  for (size_t i = 0; i + 1 < lats.size(); ++i) {
    for (size_t j = 0; j + 1 < lons.size(); ++j) {
      const double lat = (lats[i] + lats[i + 1]) / 2, lon = (lons[j] + lons[j + 1]) / 2;
      const bool held = std::any_of(parts.begin(), parts.end(), [&](const DegreeRect& rect) {
        return lat >= rect.southDeg && lat <= rect.northDeg && lon >= rect.westDeg && lon <= rect.eastDeg;
      });
      if (!held) return false;
    }
  }
  return true;
}

void ElevationLayer::addPostLines(const TileBounds& region, std::vector<double>& latDeg,
                                  std::vector<double>& lonDeg) const {
  const auto add = [](const PostAxis& axis, double fromDeg, double toDeg, double insideFromDeg, double insideToDeg,
                      double turnDeg, std::vector<double>& lines) {
    const double from = std::max(fromDeg, insideFromDeg), to = std::min(toDeg, insideToDeg);
    if (!(from < to)) return;
    for (auto k = static_cast<int64_t>(std::floor(axis.position(from - turnDeg)));; ++k) {
      const double deg = axis.deg(k) + turnDeg;
      if (deg > to || deg >= insideToDeg) break;
      if (deg >= from && deg > insideFromDeg) lines.push_back(deg);
    }
  };
  for (const ElevationFile& file : files_) {
    // Half a post more, so that rounding does not lose the outermost line.
    const DegreeRect rect = degreesOf(file.grid, kFadePosts + 0.5);
    for (const double turnDeg : {-720.0, -360.0, 0.0, 360.0}) {
      if (!overlaps(rect, region, turnDeg)) continue;
      add(lattice_.lat, rect.southDeg, rect.northDeg, region.southDeg, region.northDeg, 0, latDeg);
      add(lattice_.lon, rect.westDeg + turnDeg, rect.eastDeg + turnDeg, region.westDeg, region.eastDeg, turnDeg,
          lonDeg);
    }
  }
}

}  // namespace eye
