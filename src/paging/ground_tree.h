// What of a database's tree questions about the ground have come by: bounds of chunks, and the triangles of leaves
// within a budget. Nodes are numbers, children are found without looking anything up. One thread at a time.
#pragma once

#include <list>
#include <optional>
#include <span>

#include "paging/sibling_bounds.h"
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
    TileBounds bounds{};
    TileKey key;
    bool isLeaf = true;
    float errorM = 0;  // geometric
    std::optional<std::list<Kept>::iterator> kept;
    std::optional<uint32_t> children;  // a number of siblings(); not read yet, or a leaf
  };
  struct Siblings {
    NodeNumber first = 0;  // the others have the numbers after it
    uint32_t count = 0;
    SiblingBounds bounds;  // in this order
  };

  const DatabaseInfo& info() const { return reader_.info(); }
  // Before each question. Forgets all where there are too many nodes; then reads the octants' roots. Numbers and
  // surfaces are valid up to the next call.
  Result<void> begin();
  const Node& node(NodeNumber number) const { return nodes_[number]; }  // up to the next childrenOf or leafAt
  static constexpr size_t kMostAncestors = 8;
  // Siblings that all terrain on a line descends from: numbers for siblings(), at most kMostAncestors, up to the next
  // begin(). Lines near each other begin far down, as the way from the octants is found once for a ball that holds
  // them.
  Result<std::span<const uint32_t>> ancestorsFor(const Sight& sight);
  const Siblings& siblings(uint32_t number) const { return siblings_[number]; }  // up to the next childrenOf or leafAt
  // Up to the next childrenOf or leafAt.
  Result<const Siblings*> childrenOf(NodeNumber innerNode);
  // Of a leaf; up to the next call.
  Result<const SurfaceGrid*> surfaceOf(NodeNumber number);
  // The leaf that holds a place.
  Result<NodeNumber> leafAt(double latDeg, double lonDeg);

 private:
  Result<void> add(std::span<const TileKey> keys);
  Result<void> descendTowards(const Ball& ball);

  DatabaseReader reader_;
  std::vector<Node> nodes_;
  std::vector<Siblings> siblings_;
  std::list<Kept> kept_;  // the newest first
  size_t keptBytes_ = 0;
  Ball ball_;  // all that reaches into it descends from the ancestors; of none while its radius is negative
  std::vector<uint32_t> ancestors_, descendants_;  // the second for its memory alone
  NodeNumber lastLeaf_ = 0;                        // of a height: the next is asked nearby, mostly
};

}  // namespace eye
