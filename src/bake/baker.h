// The bake: tiles from the roots down, many threads, one writer, in an order that does not depend on them.
#pragma once

#include <atomic>
#include <functional>

#include "bake/bake_plan.h"
#include "terrain/database.h"

namespace eye {

struct BakeProgress {
  uint64_t tiles = 0;     // in the database by now
  uint64_t estimate = 0;  // of the whole, growing or shrinking as levels become known
  uint64_t baked = 0;     // by this run
  uint64_t bytes = 0;     // of blobs, by this run
  int level = 0;
};

struct BakeControl {
  int jobs = 1;
  const std::atomic<bool>* stop = nullptr;            // set: the open batch is finished, then the bake ends
  std::function<void(const BakeProgress&)> progress;  // called on the caller's thread after every family of tiles
  std::function<std::optional<Error>()> sourceError;  // asked before every commit
};

enum class BakeOutcome { complete, interrupted };

// Goes on where the database ends: what is there is kept. Children of a tile come in one transaction.
Result<BakeOutcome> bake(const BakePlan& plan, DatabaseWriter& writer, const BakeControl& control);

// One tile from scratch.
Result<StoredChunk> bakeTile(const BakePlan& plan, const TileKey& key);

}  // namespace eye
