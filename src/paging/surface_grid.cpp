#include "paging/surface_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace eye {
namespace {

constexpr int kBlock = 4;       // cells of a block, a side
constexpr int kMostCells = 32;  // of the grid, a side
constexpr double kNever = std::numeric_limits<double>::infinity();
// What rounding may put a line beside a cell's edge or a height, many times over; next to nothing of a cell.
constexpr double kSlackM = 1e-3;
constexpr double kOnTheEdge = -1e-9;  // a line along an edge meets one of its triangles

// A cell for two triangles, as posts on a lattice have them: smaller ones hold the same triangles again and again.
int sideFor(size_t triangles) {
  const double cells = std::sqrt(static_cast<double>(triangles) / 2);
  return std::clamp(static_cast<int>(std::ceil(cells / kBlock)) * kBlock, kBlock, kMostCells);
}

// Outwards, in float.
float below(double m) {
  return std::nextafter(static_cast<float>(m - kSlackM), -std::numeric_limits<float>::max());
}
float above(double m) {
  return std::nextafter(static_cast<float>(m + kSlackM), std::numeric_limits<float>::max());
}

}  // namespace

// In the local frame but for the first two. A way without x or y is divided by as well: IEEE's infinities then say what
// they should.
struct SurfaceGrid::Line {
  Vec3d fromEcef, wayEcef;  // from the chunk's origin
  Vec3d from, way;
  double perX, perY;  // 1 / way
};

SurfaceGrid::SurfaceGrid(const ChunkMesh& mesh, const ChunkMeta& meta)
    : originEcefM_(ecefFromLattice(meta.originLattice, meta.stepM())),
      minHeightM_(meta.minHeightM),
      maxHeightM_(meta.maxHeightM),
      side_(sideFor(mesh.indices.size() / 3)) {
  const Geodetic middle = geodeticFromEcef(meta.box.centreEcefM);
  ecefFromLocal_ = ecefFromEnu(middle.latDeg, middle.lonDeg);
  const Mat3d localFromEcef = glm::transpose(ecefFromLocal_);
  std::vector<Vec3d> local;
  Vec3d low(1e30), high(-1e30);
  for (const ChunkVertex& v : mesh.vertices) {
    // A step is a power of two and a vertex 16 bits, so the float is exact.
    positionsM_.push_back(glm::vec3(v.x, v.y, v.z) * static_cast<float>(meta.stepM()));
    local.push_back(localFromEcef * Vec3d(positionsM_.back()));
    low = glm::min(low, local.back());
    high = glm::max(high, local.back());
  }
  westM_ = low.x - kSlackM, southM_ = low.y - kSlackM;
  widthM_ = (high.x + kSlackM - westM_) / side_, heightM_ = (high.y + kSlackM - southM_) / side_;
  perWidth_ = 1 / widthM_, perHeight_ = 1 / heightM_;

  const auto cells = static_cast<size_t>(side_ * side_);
  cells_.resize(cells + 1);
  blocks_.resize(cells / (kBlock * kBlock));
  const auto forEachCell = [&](const auto& visit) {
    for (size_t first = 0; first + 2 < mesh.indices.size(); first += 3) {
      const uint16_t* corner = &mesh.indices[first];
      const Vec3d &a = local[corner[0]], &b = local[corner[1]], &c = local[corner[2]];
      const Vec3d least = glm::min(a, glm::min(b, c)), most = glm::max(a, glm::max(b, c));
      const Cells range = cellsOf(least, most);
      for (int row = range.south; row <= range.north; ++row)
        for (int column = range.west; column <= range.east; ++column) visit(row, column, corner, least.z, most.z);
    }
  };
  // Counted, then placed: `begin` holds each cell's count one place on, then its beginning.
  forEachCell([this](int row, int column, const uint16_t*, double lowM, double highM) {
    const size_t cell = cellAt(row, column);
    ++cells_[cell + 1].begin;
    for (HeightRange* range : {&cells_[cell].heights, &blocks_[blockAt(row / kBlock, column / kBlock)]}) {
      range->lowM = std::min(range->lowM, below(lowM));
      range->highM = std::max(range->highM, above(highM));
    }
  });
  std::vector<uint32_t> next(cells);
  for (size_t cell = 0; cell < cells; ++cell) {
    cells_[cell + 1].begin += cells_[cell].begin;
    next[cell] = cells_[cell].begin;
  }
  triangles_.resize(cells_.back().begin);
  forEachCell([&](int row, int column, const uint16_t* corner, double, double) {
    triangles_[next[cellAt(row, column)]++] = {corner[0], corner[1], corner[2]};
  });
}

size_t SurfaceGrid::blockAt(int row, int column) const {
  return static_cast<size_t>(row * (side_ / kBlock) + column);
}

SurfaceGrid::Cells SurfaceGrid::cellsOf(const Vec3d& lowM, const Vec3d& highM) const {
  const auto cellOf = [this](double offsetM, double sizeM) {
    return static_cast<int>(std::clamp(offsetM / sizeM, 0.0, side_ - 1.0));
  };
  return {cellOf(lowM.x - kSlackM - westM_, widthM_), cellOf(highM.x + kSlackM - westM_, widthM_),
          cellOf(lowM.y - kSlackM - southM_, heightM_), cellOf(highM.y + kSlackM - southM_, heightM_)};
}

SurfaceGrid::Line SurfaceGrid::lineOf(const Vec3d& fromEcefM, const Vec3d& wayEcefM) const {
  const Mat3d localFromEcef = glm::transpose(ecefFromLocal_);
  const Vec3d from = fromEcefM - originEcefM_;
  Line line{from, wayEcefM, localFromEcef * from, localFromEcef * wayEcefM, 0, 0};
  line.perX = 1 / line.way.x, line.perY = 1 / line.way.y;
  return line;
}

// After Möller and Trumbore 1997.
std::optional<Crossing> SurfaceGrid::crossingOf(const Line& line, const Triangle& triangle, double leastShare) const {
  const Vec3d a(positionsM_[triangle[0]]), b(positionsM_[triangle[1]]), c(positionsM_[triangle[2]]);
  const Vec3d ab = b - a, ac = c - a, p = glm::cross(line.wayEcef, ac);
  const double determinant = glm::dot(ab, p);
  const Vec3d fromA = line.fromEcef - a;
  const double vTimes = glm::dot(fromA, p);  // the determinant
  // Most triangles of a cell are passed on one side: that needs no division.
  const double least = leastShare * std::abs(determinant), most = (1 - leastShare) * std::abs(determinant);
  const double vSigned = determinant < 0 ? -vTimes : vTimes;
  if (determinant == 0 || vSigned < least || vSigned > most) return std::nullopt;
  const Vec3d q = glm::cross(fromA, ab);
  const double per = 1 / determinant, v = vTimes * per, w = glm::dot(line.wayEcef, q) * per;
  return Crossing{glm::dot(ac, q) * per, std::min({1 - v - w, v, w})};
}

// Steps of so many cells (all of them within `range`) that the line goes through between two of its places, in its
// order. `visit(column, row, enters, leaves)` ends the walk with true.
template <class Visit>
bool SurfaceGrid::walk(const Line& line, const Cells& range, int cellsAStep, double enters, double leaves,
                       Visit visit) const {
  const double widthM = widthM_ * cellsAStep, heightM = heightM_ * cellsAStep, perStep = 1.0 / cellsAStep;
  const auto stepOf = [perStep](double offsetM, double perCell, int low, int high) {
    return static_cast<int>(std::clamp(offsetM * perCell * perStep, double(low), double(high)));
  };
  int column = stepOf(line.from.x + line.way.x * enters - westM_, perWidth_, range.west, range.east);
  int row = stepOf(line.from.y + line.way.y * enters - southM_, perHeight_, range.south, range.north);
  const bool eastwards = line.way.x > 0, northwards = line.way.y > 0;
  const double aColumn = widthM * std::abs(line.perX), aRow = heightM * std::abs(line.perY);
  double nextColumn =
      line.way.x == 0 ? kNever : (westM_ + (column + (eastwards ? 1 : 0)) * widthM - line.from.x) * line.perX;
  double nextRow =
      line.way.y == 0 ? kNever : (southM_ + (row + (northwards ? 1 : 0)) * heightM - line.from.y) * line.perY;
  while (true) {
    const double out = std::min({nextColumn, nextRow, leaves});
    if (visit(column, row, enters, out)) return true;
    if (out >= leaves) return false;
    if (nextColumn < nextRow) {
      column += eastwards ? 1 : -1;
      if (column < range.west || column > range.east) return false;
      nextColumn += aColumn;
    } else {
      row += northwards ? 1 : -1;
      if (row < range.south || row > range.north) return false;
      nextRow += aRow;
    }
    enters = std::max(enters, out);
  }
}

std::optional<SurfaceGrid::Hit> SurfaceGrid::cast(const Vec3d& fromEcefM, const Vec3d& wayEcefM,
                                                  double untilAlong) const {
  const Line line = lineOf(fromEcefM, wayEcefM);
  // The part over the grid.
  double enters = 0, leaves = untilAlong;
  const auto clip = [&](double from, double way, double per, double low, double high) {
    if (way == 0) {
      if (from < low || from > high) leaves = -1;
      return;
    }
    const double first = (low - from) * per, second = (high - from) * per;
    enters = std::max(enters, std::min(first, second));
    leaves = std::min(leaves, std::max(first, second));
  };
  clip(line.from.x, line.way.x, line.perX, westM_, westM_ + side_ * widthM_);
  clip(line.from.y, line.way.y, line.perY, southM_, southM_ + side_ * heightM_);
  if (enters > leaves) return std::nullopt;

  const auto meets = [&line](const HeightRange& range, double begin, double end) {
    const double first = line.from.z + line.way.z * begin, second = line.from.z + line.way.z * end;
    return std::min(first, second) <= range.highM && std::max(first, second) >= range.lowM;
  };
  std::optional<Hit> best;
  double nearestAlong = untilAlong;
  const auto inCell = [&](int column, int row, double begin, double end) {
    if (begin > nearestAlong) return true;
    const size_t cell = cellAt(row, column);
    if (!meets(cells_[cell].heights, begin, end)) return false;
    for (uint32_t i = cells_[cell].begin; i < cells_[cell + 1].begin; ++i) {
      const auto crossing = crossingOf(line, triangles_[i], kOnTheEdge);
      if (!crossing || crossing->inside < kOnTheEdge || crossing->along < 0 || crossing->along > nearestAlong) continue;
      nearestAlong = crossing->along;
      best = Hit{crossing->along, i};
    }
    return false;
  };
  const auto inBlock = [&](int column, int row, double begin, double end) {
    if (begin > nearestAlong) return true;
    if (!meets(blocks_[blockAt(row, column)], begin, end)) return false;
    const Cells cells{column * kBlock, column * kBlock + kBlock - 1, row * kBlock, row * kBlock + kBlock - 1};
    return walk(line, cells, 1, begin, end, inCell);
  };
  const int last = side_ / kBlock - 1;
  walk(line, {0, last, 0, last}, kBlock, enters, leaves, inBlock);
  return best;
}

SurfaceGrid::Nearest SurfaceGrid::nearest(const Vec3d& fromEcefM, const Vec3d& wayEcefM) const {
  const Line line = lineOf(fromEcefM, wayEcefM);
  Nearest best{{0, -1e30}, 0};
  for (uint32_t triangle = 0; triangle < triangles_.size(); ++triangle) {
    const auto crossing = crossingOf(line, triangles_[triangle], -1e30);
    if (crossing && crossing->inside > best.crossing.inside) best = {*crossing, triangle};
  }
  return best;
}

Vec3d SurfaceGrid::normalEcef(uint32_t triangle) const {
  const Triangle& corner = triangles_[triangle];
  const Vec3d a(positionsM_[corner[0]]), b(positionsM_[corner[1]]), c(positionsM_[corner[2]]);
  return glm::normalize(glm::cross(b - a, c - a));
}

size_t SurfaceGrid::bytes() const {
  return sizeof(*this) + cells_.size() * sizeof(Cell) + blocks_.size() * sizeof(HeightRange) +
         triangles_.size() * sizeof(Triangle) + positionsM_.size() * sizeof(glm::vec3);
}

}  // namespace eye
