// Which triangles of a chunk may hold a place: a grid over the chunk's parameters, so that a height looks at a few
// triangles and not at all of them. Pure.
#pragma once

#include <span>
#include <vector>

#include "terrain/chunk.h"

namespace eye {

class TriangleGrid {
 public:
  TriangleGrid() = default;
  explicit TriangleGrid(const ChunkMesh& mesh);
  // First indices of triangles, all that the place (0..1) lies in, and some around it; it may lie in none of them where
  // a chunk's edge is a chord of its cell's.
  std::span<const uint32_t> near(double s, double t) const;
  size_t bytes() const { return (begins_.size() + triangles_.size()) * sizeof(uint32_t); }

 private:
  std::vector<uint32_t> begins_;     // of each cell in triangles_, row by row, and the end
  std::vector<uint32_t> triangles_;  // by cell
};

}  // namespace eye
