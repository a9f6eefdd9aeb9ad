#include "paging/terrain_cache.h"

#include <catch2/catch.hpp>

#include "paging/synthetic_forest.h"

namespace eye {
namespace {

std::vector<uint32_t> allNodes(const TerrainCache& cache) {
  std::vector<uint32_t> nodes(cache.roots().begin(), cache.roots().end());
  for (size_t i = 0; i < nodes.size(); ++i) {
    const uint32_t first = cache.node(nodes[i]).firstChild;
    for (uint32_t child = 0; child < cache.children(nodes[i]).size(); ++child) nodes.push_back(first + child);
  }
  return nodes;
}

std::vector<ResidentChunk> childrenOf(const TileKey& parent, bool hasImagery) {
  std::vector<ResidentChunk> chunks;
  for (const TileKey& key : parent.children()) {
    ResidentChunk& chunk = chunks.emplace_back();
    chunk.meta.key = key;
    chunk.meta.hasImagery = hasImagery;
  }
  return chunks;
}

void checkLinks(const TerrainCache& cache) {
  for (uint32_t index : allNodes(cache)) {
    const CacheNode& node = cache.node(index);
    REQUIRE(cache.find(node.meta.key) == index);
    for (Side side : kSides) {
      const TileList<2> across = node.meta.key.neighbours(side);
      REQUIRE(node.neighbourCount[static_cast<size_t>(side)] == across.count);
      for (size_t i = 0; i < static_cast<size_t>(across.count); ++i)
        REQUIRE(node.neighbours[static_cast<size_t>(side)][i] ==
                cache.find(across.items[i]).value_or(CacheNode::kNoNode));
    }
  }
}

}  // namespace

TEST_CASE("texture coordinates of a chunk without imagery are its nearest ancestor's") {
  const TerrainCache cache = makeForest(everywhereTo(6), around(50, 20, 3, 6));
  size_t shown = 0;
  for (uint32_t index : allNodes(cache)) {
    const CacheNode& node = cache.node(index);
    const CacheNode& texture = cache.node(node.textureNode);
    REQUIRE(texture.meta.hasImagery);
    if (node.meta.hasImagery) {
      REQUIRE(node.textureNode == index);
      REQUIRE(node.textureScale == glm::vec2(1));
      continue;
    }
    ++shown;
    for (const TileParam p : {TileParam{0, 0}, TileParam{1, 0}, TileParam{0.25, 0.75}, TileParam{1, 1}}) {
      const TileParam expected = paramFromLatLon(texture.meta.key, latLonFromParam(node.meta.key, p));
      const glm::vec2 got = node.textureScale * glm::vec2(glm::dvec2(p.s, p.t)) + node.textureOffset;
      REQUIRE(std::abs(got.x - expected.s) < 1e-6);
      REQUIRE(std::abs(got.y - expected.t) < 1e-6);
    }
  }
  CHECK(shown > 50);
}

TEST_CASE("imagery that a damaged database lacks beside a pole is replaced by something within the texture") {
  TerrainCache cache = makeForest(everywhereTo(1), everywhereTo(0));
  for (uint32_t root : {cache.roots()[0], cache.roots()[6]}) {
    cache.insertChildren(root, childrenOf(cache.node(root).meta.key, false));
    for (uint32_t i = 0; i < 3; ++i) {
      const CacheNode& child = cache.node(cache.node(root).firstChild + i);
      CHECK(child.textureNode == root);
      CHECK(glm::all(glm::greaterThanEqual(child.textureOffset, glm::vec2(0))));
      CHECK(glm::all(glm::lessThanEqual(child.textureOffset + child.textureScale, glm::vec2(1))));
    }
  }
}

TEST_CASE("neighbours stay linked while chunks come and go, and their slots are used again") {
  TerrainCache cache = makeForest(everywhereTo(5), around(0, 0, 2, 5));
  checkLinks(cache);
  const size_t size = cache.size();
  cache.beginFrame();
  std::vector<EvictableGroup> groups;
  cache.evictableGroups({.usedBefore = 0}, groups);
  CHECK(groups.empty());
  std::vector<TileKey> removed;
  for (int round = 0; round < 3; ++round) {
    cache.evictableGroups({.usedBefore = cache.frame()}, groups);
    REQUIRE(!groups.empty());
    for (const EvictableGroup& group : groups) {
      const uint32_t parent = group.parent;
      removed.push_back(cache.node(parent).meta.key);
      cache.removeChildren(parent);
    }
    checkLinks(cache);
  }
  uint32_t highest = 0;
  while (!removed.empty()) {
    const TileKey parent = removed.back();
    removed.pop_back();
    cache.insertChildren(*cache.find(parent), childrenOf(parent, true));
    highest = std::max(highest, cache.node(*cache.find(parent)).firstChild);
  }
  checkLinks(cache);
  CHECK(cache.size() == size);
  CHECK(highest < size * 4 / 3 + 8);
}

}  // namespace eye
