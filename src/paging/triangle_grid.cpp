#include "paging/triangle_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace eye {
namespace {

constexpr int kCells = 16;  // a side: a chunk has 100 to 700 triangles
// Straight edges in space are curved in parameters: by width / 8 Earth radii of the chunk's width, 1 % at 500 km.
constexpr double kSlack = 0.01;

int cellOf(double parameter) {
  return std::clamp(static_cast<int>(std::floor(parameter * kCells)), 0, kCells - 1);
}

struct Cells {
  int west, east, south, north;  // inclusive
};

Cells cellsOf(const ChunkMesh& mesh, size_t firstIndex) {
  constexpr double kUnit = std::numeric_limits<uint16_t>::max();
  double low[2] = {1, 1}, high[2] = {0, 0};
  for (size_t i = firstIndex; i < firstIndex + 3; ++i) {
    const ChunkVertex& vertex = mesh.vertices[mesh.indices[i]];
    const double at[2] = {vertex.s / kUnit, vertex.t / kUnit};
    for (size_t axis = 0; axis < 2; ++axis) {
      low[axis] = std::min(low[axis], at[axis]);
      high[axis] = std::max(high[axis], at[axis]);
    }
  }
  return {cellOf(low[0] - kSlack), cellOf(high[0] + kSlack), cellOf(low[1] - kSlack), cellOf(high[1] + kSlack)};
}

}  // namespace

TriangleGrid::TriangleGrid(const ChunkMesh& mesh) : begins_(kCells * kCells + 1, 0) {
  const auto forEachCell = [&mesh](const auto& visit) {
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      const Cells cells = cellsOf(mesh, i);
      for (int row = cells.south; row <= cells.north; ++row)
        for (int column = cells.west; column <= cells.east; ++column)
          visit(static_cast<size_t>(row * kCells + column), static_cast<uint32_t>(i));
    }
  };
  // Counted, then placed: begins_ holds each cell's count one place on, then its beginning.
  forEachCell([this](size_t cell, uint32_t) { ++begins_[cell + 1]; });
  for (size_t cell = 1; cell < begins_.size(); ++cell) begins_[cell] += begins_[cell - 1];
  triangles_.resize(begins_.back());
  std::vector<uint32_t> next(begins_.begin(), begins_.end() - 1);
  forEachCell([&](size_t cell, uint32_t triangle) { triangles_[next[cell]++] = triangle; });
}

std::span<const uint32_t> TriangleGrid::near(double s, double t) const {
  const auto cell = static_cast<size_t>(cellOf(t) * kCells + cellOf(s));
  return std::span(triangles_).subspan(begins_[cell], begins_[cell + 1] - begins_[cell]);
}

}  // namespace eye
