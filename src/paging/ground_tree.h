// What of a database's tree questions about the ground have come by: bounds of chunks, and the triangles of leaves
// within a budget. Nodes are numbers, children are found without looking anything up. One thread at a time.
#pragma once

#include <list>
#include <optional>

#include "paging/surface_grid.h"
#include "terrain/database.h"

namespace eye {

class GroundTree {
 public:
  explicit GroundTree(DatabaseReader reader) : reader_(std::move(reader)) {}

  using NodeNumber = uint32_t;
  struct Kept {
    NodeNumber leaf;
    SurfaceGrid surface;
  };
  struct Node {
    Vec3d sphereCentreEcefM{};
    double sphereRadiusM = 0;
    Vec3d boxCentreEcefM{};
    std::array<Vec3d, 3> boxAxes{};  // unit
    std::array<double, 3> boxExtentsM{};
    TileBounds bounds{};
    TileKey key;
    bool isLeaf = true;
    NodeNumber firstChild = 0;  // 0: not read yet, or a leaf
    uint32_t childCount = 0;
    std::optional<std::list<Kept>::iterator> kept;
  };

  // Before each question. Forgets all where there are too many nodes; then reads the octants' roots, numbers 0 to 7.
  // Numbers and surfaces are valid up to the next call.
  Result<void> begin();
  const Node& node(NodeNumber number) const { return nodes_[number]; }  // up to the next childrenOf or leafAt
  // The first child of an inner node; the others have the numbers after it.
  Result<NodeNumber> childrenOf(NodeNumber number);
  // Of a leaf; up to the next call.
  Result<const SurfaceGrid*> surfaceOf(NodeNumber number);
  // The leaf that holds a place.
  Result<NodeNumber> leafAt(double latDeg, double lonDeg);

 private:
  Result<void> add(const TileKey& key);

  DatabaseReader reader_;
  std::vector<Node> nodes_;
  std::list<Kept> kept_;  // the newest first
  size_t keptBytes_ = 0;
  NodeNumber lastLeaf_ = 0;  // of a height: the next is asked nearby, mostly
};

}  // namespace eye
