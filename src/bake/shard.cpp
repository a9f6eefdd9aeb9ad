#include "bake/shard.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <numeric>
#include <vector>

#include <fmt/format.h>

#include "bake/bake_estimate.h"

namespace eye {

namespace {

// What all shards make is at most this part of what each makes of its own: the lower the level that is dealt out, the
// more evenly the work falls, also where most of it lies in one small region.
constexpr double kMostShared = 0.25;
constexpr const char* kMark = "; shard ";

// Those of the tiles that may get children.
std::vector<TileKey> parentsOf(const BakePlan& plan, const std::vector<TileKey>& tiles) {
  std::vector<TileKey> parents;
  for (const TileKey& key : tiles)
    if (plan.wantsChildren(key, std::numeric_limits<double>::infinity())) parents.push_back(key);
  return parents;
}

std::vector<TileKey> childrenOf(const std::vector<TileKey>& parents) {
  std::vector<TileKey> children;
  for (const TileKey& parent : parents)
    for (const TileKey& child : parent.children()) children.push_back(child);
  return children;
}

}  // namespace

std::optional<Shard> parseShard(const std::string& text) {
  Shard shard;
  const char *const begin = text.data(), *const end = begin + text.size();
  const auto index = std::from_chars(begin, end, shard.index);
  if (index.ec != std::errc() || index.ptr == end || *index.ptr != '/') return std::nullopt;
  const auto count = std::from_chars(index.ptr + 1, end, shard.count);
  if (count.ec != std::errc() || count.ptr != end) return std::nullopt;
  const bool valid = shard.index >= 1 && shard.index <= shard.count && shard.count <= kMostShards;
  return valid ? std::optional(shard) : std::nullopt;
}

ShardTiles::ShardTiles(const BakePlan& plan) {
  if (!plan.shard) return;
  const std::vector<double> most = mostTiles(plan);
  const double mostShared = kMostShared * std::accumulate(most.begin(), most.end(), 0.0) / plan.shard->count;
  splitLevel_ = 0;
  double shared = most.front();
  for (size_t level = 1; level < most.size() && shared + most[level] <= mostShared; ++level, ++splitLevel_) {
    shared += most[level];
  }
  share_ = 1.0 / plan.shard->count;

  std::vector<TileKey> tiles;
  for (int octant = 0; octant < kOctants; ++octant) tiles.push_back(TileKey::octantRoot(octant));
  for (int level = 0; level < splitLevel_; ++level) tiles = childrenOf(parentsOf(plan, tiles));
  std::vector<TileKey> dealt = parentsOf(plan, tiles);
  std::sort(dealt.begin(), dealt.end());
  // In turn: neighbours cost about the same.
  const auto count = static_cast<size_t>(plan.shard->count);
  for (size_t i = static_cast<size_t>(plan.shard->index - 1); i < dealt.size(); i += count) mine_.insert(dealt[i]);
}

std::string describeShard(const Shard& shard) {
  return fmt::format("{}{}/{}", kMark, shard.index, shard.count);
}

std::optional<ShardDescription> shardFrom(const std::string& description) {
  const size_t at = description.rfind(kMark);
  if (at == std::string::npos) return std::nullopt;
  const std::optional<Shard> shard = parseShard(description.substr(at + std::string(kMark).size()));
  if (!shard) return std::nullopt;
  return ShardDescription{description.substr(0, at), *shard};
}

}  // namespace eye
