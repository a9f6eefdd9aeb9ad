// What the walk of this frame met across a chunk's side. Owner thread: render.
#pragma once

#include "paging/terrain_cache.h"

namespace eye {

// Whether this frame's walk reached the node.
inline bool isVisited(const TerrainCache& cache, const CacheNode& node) {
  return node.usedFrame == cache.frame() && node.visit != Visit::none;
}

// Calls f(index) for nodes that cover the cells of the node's own level across the side: each such cell itself where
// the walk reached it, else the ancestor at which the walk stopped. At pole cells f may also get a node that only
// touches the cell's parent: for skirts and culling that errs on the safe side.
template <class F>
void forEachAcross(const TerrainCache& cache, uint32_t index, Side side, const F& f, bool isParent = false) {
  const CacheNode& node = cache.node(index);
  const auto s = static_cast<size_t>(side);
  bool someNotResident = false;
  for (size_t i = 0; i < node.neighbourCount[s]; ++i) {
    uint32_t other = node.neighbours[s][i];
    if (other == CacheNode::kNoNode) {
      someNotResident = true;
      continue;
    }
    while (!isVisited(cache, cache.node(other))) other = cache.node(other).parent;
    // A refined neighbour of the parent has children: it is not the one whose children are missing.
    if (!isParent || cache.node(other).visit != Visit::refined) f(other);
  }
  // The cell is not resident, so it is no sibling: its parent lies across the same side of this one's.
  if (someNotResident) forEachAcross(cache, node.parent, side, f, true);
}

}  // namespace eye
