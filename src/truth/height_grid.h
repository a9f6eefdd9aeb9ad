// The elevation that the truth tests compare with: one regular grid of posts, bilinear between them, read from .hgt
// files by a reader of its own or filled by a function.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace eye::truth {

struct GridShape {
  double southDeg = 0, westDeg = 0;  // of the first post
  double stepDeg = 0;                // between posts, both ways
  int rows = 0, columns = 0;         // posts; rows run northwards
};

class HeightGrid {
 public:
  HeightGrid(const GridShape& shape, const std::function<double(double latDeg, double lonDeg)>& heightM);
  // The same by row and column, a row after the other.
  static HeightGrid fromPosts(const GridShape& shape, const std::function<double(int row, int column)>& heightM);
  // Every NxxEyyy.hgt of a folder, which must fill a rectangle. Posts that two files share with different values are
  // averaged. Returns an empty grid (rows == 0) where there is none.
  static HeightGrid fromHgtFolder(const std::string& folder);

  const GridShape& shape() const { return shape_; }
  bool empty() const { return shape_.rows == 0; }
  // Posts without a value: what a bake puts there is a guess, so the truth is unknown near them.
  int voids() const { return voids_; }
  // Grid coordinates: 0 at the first post, 1 a post.
  double rowOf(double latDeg) const { return (latDeg - shape_.southDeg) / shape_.stepDeg; }
  double columnOf(double lonDeg) const { return (lonDeg - shape_.westDeg) / shape_.stepDeg; }
  // Bilinear; NaN at a void. Inside the grid only (clamped to its edge).
  double heightM(double row, double column) const;
  float postM(int row, int column) const { return posts_[index(row, column)]; }

  // The highest post of a block of 2^level x 2^level cells and of the cells around it, so that a ray that strays a
  // little from the block is still under it. A void counts as 300 m above the highest post near it.
  float highestM(int level, int blockRow, int blockColumn) const;
  int levels() const { return static_cast<int>(pyramid_.size()); }
  float highestPostM() const { return highestPostM_; }
  float highestBorderPostM() const { return highestBorderPostM_; }

 private:
  HeightGrid() = default;
  size_t index(int row, int column) const {
    return static_cast<size_t>(row) * static_cast<size_t>(shape_.columns) + static_cast<size_t>(column);
  }
  std::vector<float> postsWithVoidsRaised() const;
  void buildPyramid();

  struct Level {
    int rows = 0, columns = 0;
    std::vector<float> highestM;
  };
  GridShape shape_;
  std::vector<float> posts_;
  std::vector<Level> pyramid_;
  int voids_ = 0;
  float highestPostM_ = 0, highestBorderPostM_ = 0;
};

}  // namespace eye::truth
