#include "paging/terrain_cache.h"

#include <algorithm>
#include <limits>

namespace eye {
namespace {

constexpr uint32_t kNoNode = CacheNode::kNoNode;

Side opposite(Side side) {
  return static_cast<Side>((static_cast<int>(side) + 2) % 4);
}

struct ParamMap {
  glm::vec2 scale{1.0f}, offset{0.0f};
};

// From a cell's parameters to its parent's. Between ordinary cells both are linear in degrees; between pole cells only
// the radius halves. A pole cell's ordinary child has no affine map: it shows the one colour at its middle, which only
// a damaged database asks for, since such cells have imagery of their own.
ParamMap parentFromChild(const TileKey& parent, const TileKey& child) {
  if (child.isPolar()) return {glm::vec2(0.5f), glm::vec2(0.0f)};
  const TileBounds c = child.bounds();
  if (parent.isPolar()) {
    const LatLon middle{(c.southDeg + c.northDeg) / 2, (c.westDeg + c.eastDeg) / 2};
    const TileParam p = paramFromLatLon(parent, middle);
    return {glm::vec2(0.0f), glm::clamp(glm::vec2(glm::dvec2(p.s, p.t)), 0.0f, 1.0f)};
  }
  const TileBounds p = parent.bounds();
  const double widthDeg = p.eastDeg - p.westDeg, heightDeg = p.northDeg - p.southDeg;
  return {glm::vec2(glm::dvec2((c.eastDeg - c.westDeg) / widthDeg, (c.northDeg - c.southDeg) / heightDeg)),
          glm::vec2(glm::dvec2((c.westDeg - p.westDeg) / widthDeg, (c.southDeg - p.southDeg) / heightDeg))};
}

}  // namespace

size_t LoadedChunk::bytes() const {
  return sizeof(LoadedChunk) + mesh.vertices.capacity() * sizeof(ChunkVertex) +
         mesh.indices.capacity() * sizeof(uint16_t) + mesh.clusters.capacity() * sizeof(ChunkCluster) +
         texels.capacity();
}

std::optional<uint32_t> TerrainCache::find(const TileKey& key) const {
  const auto found = indexOf_.find(key);
  return found == indexOf_.end() ? std::nullopt : std::optional(found->second);
}

std::span<const CacheNode> TerrainCache::children(uint32_t parent) const {
  const CacheNode& p = nodes_[parent];
  if (p.firstChild == kNoNode) return {};
  return {&nodes_[p.firstChild], p.meta.key.isPolar() ? size_t{3} : size_t{4}};
}

void TerrainCache::insertRoots(std::span<const ResidentChunk> roots) {
  EYE_CHECK(roots_.empty() && roots.size() == kOctants);
  for (const ResidentChunk& root : roots) {
    EYE_CHECK(root.meta.hasImagery);
    if (roots_.size() % kSlots == 0) takeSlots();
    const auto index = static_cast<uint32_t>(roots_.size());
    roots_.push_back(index);
    place(index, kNoNode, root);
  }
}

void TerrainCache::insertChildren(uint32_t parent, std::span<const ResidentChunk> children) {
  const TileList<4> keys = nodes_[parent].meta.key.children();
  EYE_CHECK(nodes_[parent].firstChild == kNoNode && children.size() == static_cast<size_t>(keys.count));
  const uint32_t first = takeSlots();
  groupParents_[first / kSlots] = parent;
  nodes_[parent].firstChild = first;
  for (uint32_t i = 0; i < children.size(); ++i) {
    EYE_CHECK(children[i].meta.key == keys.items[i]);
    place(first + i, parent, children[i]);
  }
}

void TerrainCache::removeChildren(uint32_t parent) {
  const size_t count = children(parent).size();
  const uint32_t first = nodes_[parent].firstChild;
  for (uint32_t i = first; i < first + count; ++i) {
    EYE_CHECK(nodes_[i].firstChild == kNoNode);
    unlink(i);
    indexOf_.erase(nodes_[i].meta.key);
  }
  if (count == 0) return;
  nodes_[parent].firstChild = kNoNode;
  groupParents_[first / kSlots] = kNoNode;
  freeGroups_.push_back(first / kSlots);
}

void TerrainCache::evictableGroups(const EvictionRule& rule, std::vector<EvictableGroup>& groups) const {
  groups.clear();
  for (uint32_t group = 0; group < groupParents_.size(); ++group) {
    const uint32_t parent = groupParents_[group];
    // A walk that reaches one child reaches all of them: the first one's frame is the group's.
    if (parent == kNoNode) continue;
    const CacheNode& first = nodes_[group * kSlots];
    if (first.usedFrame >= rule.usedBefore) continue;
    const auto isChildless = [](const CacheNode& child) { return child.firstChild == kNoNode; };
    if (!std::ranges::all_of(children(parent), isChildless)) continue;
    const bool scheduled = rule.plan != 0 && first.plan == rule.plan;
    const auto frame = static_cast<double>(std::max(first.usedFrame, first.scheduledFrame));
    groups.push_back({parent, frame + rule.framesPerInterval * (kMaxLevel - first.meta.key.level()),
                      scheduled ? first.neededAtS : std::numeric_limits<double>::infinity()});
  }
  std::ranges::sort(groups, [this](const EvictableGroup& a, const EvictableGroup& b) {
    if (a.neededAtS != b.neededAtS) return a.neededAtS > b.neededAtS;
    if (a.p != b.p) return a.p < b.p;
    return nodes_[a.parent].meta.key.code() < nodes_[b.parent].meta.key.code();
  });
}

size_t TerrainCache::groupsUnusedSince(uint64_t usedBefore) const {
  size_t groups = 0;
  for (size_t group = 0; group < groupParents_.size(); ++group)
    groups += groupParents_[group] != kNoNode && nodes_[group * kSlots].usedFrame < usedBefore;
  return groups;
}

uint32_t TerrainCache::takeSlots() {
  if (freeGroups_.empty()) {
    freeGroups_.push_back(static_cast<uint32_t>(groupParents_.size()));
    groupParents_.push_back(kNoNode);
    nodes_.resize(nodes_.size() + kSlots);
  }
  const uint32_t group = freeGroups_.back();
  freeGroups_.pop_back();
  return group * kSlots;
}

void TerrainCache::place(uint32_t index, uint32_t parent, const ResidentChunk& chunk) {
  CacheNode node;
  node.meta = chunk.meta;
  node.gpu = chunk.gpu;
  node.skirts = chunk.skirts;
  node.surfaceIndexCount = chunk.surfaceIndexCount;
  node.longestEdgeM = chunk.longestEdgeM;
  node.parent = parent;
  node.textureNode = index;
  node.usedFrame = frame_;  // new is not old: it is not the first to be evicted
  if (!chunk.meta.hasImagery) {
    const CacheNode& p = nodes_[parent];
    const ParamMap map = parentFromChild(p.meta.key, chunk.meta.key);
    node.textureNode = p.textureNode;
    node.textureScale = p.textureScale * map.scale;
    node.textureOffset = p.textureScale * map.offset + p.textureOffset;
  }
  nodes_[index] = node;
  indexOf_[chunk.meta.key] = index;
  link(index);
}

// Both ways: a neighbour across a side has this cell across its opposite side, without exception, since the grid has
// none across a pole.
void TerrainCache::link(uint32_t index) {
  CacheNode& node = nodes_[index];
  for (Side side : kSides) {
    const auto s = static_cast<size_t>(side), o = static_cast<size_t>(opposite(side));
    const TileList<2> across = node.meta.key.neighbours(side);
    node.neighbourCount[s] = static_cast<uint8_t>(across.count);
    node.neighbours[s] = {kNoNode, kNoNode};
    for (int i = 0; i < across.count; ++i) {
      const std::optional<uint32_t> other = find(across.items[static_cast<size_t>(i)]);
      if (!other) continue;
      node.neighbours[s][static_cast<size_t>(i)] = *other;
      const TileList<2> back = nodes_[*other].meta.key.neighbours(opposite(side));
      for (int j = 0; j < back.count; ++j) {
        if (back.items[static_cast<size_t>(j)] == node.meta.key)
          nodes_[*other].neighbours[o][static_cast<size_t>(j)] = index;
      }
    }
  }
}

void TerrainCache::unlink(uint32_t index) {
  for (Side side : kSides) {
    for (uint32_t other : nodes_[index].neighbours[static_cast<size_t>(side)]) {
      if (other == kNoNode) continue;
      for (uint32_t& back : nodes_[other].neighbours[static_cast<size_t>(opposite(side))]) {
        if (back == index) back = kNoNode;
      }
    }
  }
}

}  // namespace eye
