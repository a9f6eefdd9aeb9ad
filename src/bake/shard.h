// A bake shared out among processes or machines: which tiles each of them makes.
//
// Every shard makes the tiles down to a level above which little of the bake lies, so that it is a database of its own;
// below, the descendants of every count-th parent of that level. These are chosen by the plan alone, never by what was
// baked, so that shards need not know of each other.
#pragma once

#include <optional>
#include <string>
#include <unordered_set>

#include "bake/bake_plan.h"

namespace eye {

// "2/4" is index 2 of count 4. Nothing where it is not that, or not 1 <= index <= count <= kMostShards.
inline constexpr int kMostShards = 4096;
std::optional<Shard> parseShard(const std::string& text);

// Thread: any number at once.
class ShardTiles {
 public:
  explicit ShardTiles(const BakePlan& plan);
  // Whether this shard makes the children of a tile that wants some.
  bool bakesBelow(const TileKey& key) const { return key.level() != splitLevel_ || mine_.contains(key); }
  // Of a level's tiles, about so much is this shard's.
  double share(int level) const { return level > splitLevel_ ? share_ : 1; }

 private:
  int splitLevel_ = kMaxLevel;  // of the parents that are dealt out; kMaxLevel, which has none: nothing is shared
  double share_ = 1;
  std::unordered_set<TileKey> mine_;
};

// What a shard's DatabaseInfo::description ends with, and what it is without that.
std::string describeShard(const Shard& shard);
struct ShardDescription {
  std::string sources;
  Shard shard;
};
std::optional<ShardDescription> shardFrom(const std::string& description);

}  // namespace eye
