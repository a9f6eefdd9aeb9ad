// A chunk's triangles as lines meet them: in a frame of their own with its z upwards, sorted into a grid over x and y
// whose cells know the heights of what they hold. A line is straight there, so it walks from cell to cell and passes
// those that it flies over or under; first blocks of cells, then cells. Pure.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "terrain/chunk.h"

namespace eye {

// Where a line meets a triangle's plane.
struct Crossing {
  double along = 0;   // 0 at the line's first point, 1 at its second
  double inside = 0;  // the least of the three corners' shares: negative outside the triangle
};

class SurfaceGrid {
 public:
  SurfaceGrid() = default;
  SurfaceGrid(const ChunkMesh& mesh, const ChunkMeta& meta);

  struct Hit {
    double along = 0;
    uint32_t triangle = 0;
  };
  // The nearest hit on the line from `fromEcefM` along `wayEcefM`, up to the share `untilAlong` of it; either side.
  std::optional<Hit> cast(const Vec3d& fromEcefM, const Vec3d& wayEcefM, double untilAlong) const;
  // The triangle that the line goes through or comes nearest to; all of them are looked at.
  struct Nearest {
    Crossing crossing;
    uint32_t triangle = 0;
  };
  Nearest nearest(const Vec3d& fromEcefM, const Vec3d& wayEcefM) const;
  Vec3d normalEcef(uint32_t triangle) const;  // unit, outwards

  double minHeightM() const { return minHeightM_; }  // geodetic
  double maxHeightM() const { return maxHeightM_; }
  size_t bytes() const;

 private:
  struct HeightRange {
    float lowM = 1e30f, highM = -1e30f;  // nothing is in it
  };
  struct Cell {
    HeightRange heights;
    uint32_t begin = 0;  // of its triangles, which end where the next cell's begin
  };
  using Triangle = std::array<uint16_t, 3>;  // vertices
  struct Line;
  struct Cells {
    int west, east, south, north;  // inclusive
  };
  Cells cellsOf(const Vec3d& lowM, const Vec3d& highM) const;
  Line lineOf(const Vec3d& fromEcefM, const Vec3d& wayEcefM) const;
  // Nothing where one of the shares is below `leastShare` for sure.
  std::optional<Crossing> crossingOf(const Line& line, const Triangle& triangle, double leastShare) const;
  size_t cellAt(int row, int column) const { return static_cast<size_t>(row * side_ + column); }
  size_t blockAt(int row, int column) const;
  template <class Visit>
  bool walk(const Line& line, const Cells& range, int cellsAStep, double enters, double leaves, Visit visit) const;

  Vec3d originEcefM_{};
  Mat3d ecefFromLocal_{1.0};
  double minHeightM_ = 0, maxHeightM_ = 0;
  int side_ = 1;                                              // cells along the grid's side, a multiple of a block's
  double westM_ = 0, southM_ = 0, widthM_ = 1, heightM_ = 1;  // of the grid's corner; of a cell
  double perWidth_ = 1, perHeight_ = 1;                       // 1 / of a cell
  std::vector<Cell> cells_;                                   // row by row, and one more that tells the end
  std::vector<HeightRange> blocks_;                           // row by row
  std::vector<Triangle> triangles_;                           // by cell, in each that they reach into
  std::vector<glm::vec3> positionsM_;  // ecef from the origin, exact: neighbours' edges are the same to the last bit
};

}  // namespace eye
