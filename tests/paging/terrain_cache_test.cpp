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

TEST_CASE("equation (12): of one age the finer goes first, of one level the older; the region goes last") {
  TerrainCache cache = makeForest(everywhereTo(4), [](const TileKey& key) { return key.level() <= key.octant() % 4; });
  std::vector<EvictableGroup> groups;
  for (int i = 0; i < 100; ++i) cache.beginFrame();
  const auto levelOf = [&](const EvictableGroup& group) { return cache.node(group.parent).meta.key.level(); };
  cache.evictableGroups({.usedBefore = 100, .framesPerInterval = 30}, groups);
  REQUIRE(groups.size() > 5);
  REQUIRE(levelOf(groups.front()) > levelOf(groups.back()));
  for (size_t i = 1; i < groups.size(); ++i) CHECK(levelOf(groups[i]) <= levelOf(groups[i - 1]));

  // Used 31 frames later a fine group outlives one that is a level coarser, 29 frames later it does not.
  const uint32_t fine = groups.front().parent;
  const auto coarse =
      std::ranges::find_if(groups, [&](const auto& g) { return levelOf(g) + 1 == levelOf(groups.front()); });
  REQUIRE(coarse != groups.end());
  const uint32_t coarser = coarse->parent;
  const auto comesBefore = [&](uint32_t a, uint32_t b) {
    cache.evictableGroups({.usedBefore = 100, .plan = 5, .framesPerInterval = 30}, groups);
    const auto at = [&](uint32_t parent) { return std::ranges::find(groups, parent, &EvictableGroup::parent); };
    return at(a) < at(b);
  };
  const auto useChildren = [&](uint32_t parent, uint64_t frame) {
    for (uint32_t i = 0; i < 4; ++i) cache.node(cache.node(parent).firstChild + i).usedFrame = frame;
  };
  const uint64_t frame = cache.node(cache.node(coarser).firstChild).usedFrame;
  useChildren(fine, frame + 29);
  CHECK(comesBefore(fine, coarser));
  useChildren(fine, frame + 31);
  CHECK_FALSE(comesBefore(fine, coarser));

  // In the region: after all others, the last needed first.
  const auto schedule = [&](uint32_t parent, double neededAtS) {
    for (uint32_t i = 0; i < 4; ++i) {
      cache.node(cache.node(parent).firstChild + i).plan = 5;
      cache.node(cache.node(parent).firstChild + i).neededAtS = neededAtS;
    }
  };
  schedule(fine, 3);
  schedule(coarser, 2);
  CHECK(comesBefore(fine, coarser));
  CHECK(groups[groups.size() - 2].parent == fine);
  CHECK(groups.back().parent == coarser);
  CHECK(groups.back().neededAtS == 2);
}

}  // namespace eye
