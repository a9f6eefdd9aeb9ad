#include "bake/baker.h"

#include <algorithm>

#include "bake/bake_estimate.h"
#include "bake/mesher.h"
#include "bake/ordered_parallel.h"
#include "bake/shard.h"
#include "bake/tile_painter.h"

namespace eye {

namespace {

// Tiles a transaction: large enough that commits cost nothing, small enough that a kill loses seconds.
constexpr size_t kBatchTiles = 256;

// Tiles that come together: the children of a parent, or a root alone.
struct Family {
  std::optional<TileKey> parent;
  std::vector<TileKey> members;
};

using BakedFamily = Result<std::vector<StoredChunk>>;

class Writing {
 public:
  Writing(const BakePlan& plan, DatabaseWriter& writer, const BakeControl& control)
      : plan_(plan), mine_(plan), writer_(writer), control_(control) {
    if (!control.progress) return;
    most_ = mostTiles(plan);
    for (size_t level = 0; level < most_.size(); ++level) most_[level] *= mine_.share(static_cast<int>(level));
  }

  // Tells which members are to have children.
  Result<void> take(const Family& family, std::vector<StoredChunk> chunks, std::vector<TileKey>& parents) {
    if (pending_ == 0) {
      if (auto begun = writer_.begin(); !begun) return begun;
    }
    for (const StoredChunk& chunk : chunks) {
      if (auto put = writer_.putChunk(chunk); !put) return put;
      ++progress_.baked;
      progress_.bytes += chunk.mesh.size() + chunk.imagery.size();
      if (makesChildren(chunk.meta)) parents.push_back(chunk.meta.key);
    }
    if (family.parent) {
      if (auto set = writer_.setChildren(*family.parent, static_cast<int>(chunks.size())); !set) return set;
    }
    pending_ += chunks.size();
    progress_.tiles += chunks.size();
    return pending_ >= kBatchTiles ? commit() : Result<void>{};
  }

  // Members that are in the database already. Those with children want them; the others' errors are still their own.
  Result<void> keep(const Family& family, std::vector<TileKey>& parents) {
    for (const TileKey& key : family.members) {
      const auto meta = writer_.readMeta(key);
      if (!meta) return tl::unexpected(meta.error());
      if (!*meta) return fail(ErrorKind::badData, key.name() + " is missing from the database; bake it anew");
      if ((*meta)->childCount > 0 || makesChildren(**meta)) parents.push_back(key);
    }
    progress_.tiles += family.members.size();
    return {};
  }

  Result<void> commit() {
    if (pending_ == 0) return {};
    if (control_.sourceError) {
      if (const std::optional<Error> error = control_.sourceError()) return tl::unexpected(*error);
    }
    pending_ = 0;
    return writer_.commit();
  }

  // `familiesLeft` of this level are still to come; deeper levels are taken to be filled as well as this one.
  void report(int level, size_t familiesLeft) {
    if (!control_.progress) return;
    progress_.level = level;
    const double levelTiles =
        static_cast<double>(progress_.tiles - beforeLevel_) + 4.0 * static_cast<double>(familiesLeft);
    double tiles = levelTiles;
    const auto here = static_cast<size_t>(level);
    for (size_t below = here + 1; here < most_.size() && below < most_.size(); ++below) {
      tiles += most_[below] * std::min(1.0, levelTiles / most_[here]);
    }
    progress_.estimate = beforeLevel_ + static_cast<uint64_t>(tiles);
    control_.progress(progress_);
  }
  void beginLevel() { beforeLevel_ = progress_.tiles; }

  bool shouldStop() const { return control_.stop != nullptr && control_.stop->load(); }

 private:
  bool makesChildren(const ChunkMeta& meta) const {
    return plan_.wantsChildren(meta.key, meta.geometricErrorM) && mine_.bakesBelow(meta.key);
  }

  const BakePlan& plan_;
  const ShardTiles mine_;
  DatabaseWriter& writer_;
  const BakeControl& control_;
  std::vector<double> most_;  // tiles by level, at most
  uint64_t beforeLevel_ = 0;  // tiles above the level at hand
  size_t pending_ = 0;        // tiles in the open transaction
  BakeProgress progress_;
};

BakedFamily bakeFamily(const BakePlan& plan, const Family& family) {
  std::vector<StoredChunk> chunks;
  for (const TileKey& key : family.members) {
    Result<StoredChunk> chunk = bakeTile(plan, key);
    if (!chunk) return tl::unexpected(chunk.error());
    chunks.push_back(std::move(*chunk));
  }
  return chunks;
}

// Splits off what the database has already.
Result<std::vector<Family>> missingOf(const std::vector<Family>& families, DatabaseWriter& writer, Writing& writing,
                                      std::vector<TileKey>& parents) {
  std::vector<Family> missing;
  for (const Family& family : families) {
    const Result<bool> there = writer.contains(family.members.front());
    if (!there) return tl::unexpected(there.error());
    if (!*there) {
      missing.push_back(family);
    } else if (auto kept = writing.keep(family, parents); !kept) {
      return tl::unexpected(kept.error());
    }
  }
  return missing;
}

std::vector<Family> familiesOf(std::vector<TileKey> parents) {
  std::sort(parents.begin(), parents.end());
  std::vector<Family> families;
  for (const TileKey& parent : parents) {
    const TileList<4> children = parent.children();
    families.push_back({parent, {children.begin(), children.end()}});
  }
  return families;
}

}  // namespace

Result<StoredChunk> bakeTile(const BakePlan& plan, const TileKey& key) {
  MeshedTile tile = meshTile(*plan.surface, key, [&](const TileKey& of) { return plan.toleranceM(of); });
  StoredChunk chunk;
  chunk.meta = tile.meta;
  chunk.meta.texelErrorM = plan.texelErrorM(key);
  chunk.meta.childCount = 0;
  chunk.meta.hasImagery = plan.hasImagery(key);
  chunk.mesh = encodeMesh(tile.mesh);
  if (chunk.meta.hasImagery) {
    const auto rgb = paintTile(key, plan.textureSize, *plan.surface, plan.imagery);
    if (!rgb) return tl::unexpected(rgb.error());
    chunk.imagery = encodeImagery(*rgb, plan.textureSize);
  }
  return chunk;
}

Result<BakeOutcome> bake(const BakePlan& plan, DatabaseWriter& writer, const BakeControl& control) {
  Writing writing(plan, writer, control);
  std::vector<Family> families;
  for (int octant = 0; octant < kOctants; ++octant) families.push_back({std::nullopt, {TileKey::octantRoot(octant)}});
  for (int level = 0; !families.empty(); ++level) {
    std::vector<TileKey> parents;
    writing.beginLevel();
    const Result<std::vector<Family>> missing = missingOf(families, writer, writing, parents);
    if (!missing) return tl::unexpected(missing.error());

    Result<void> result;
    orderedParallel<BakedFamily>(
        missing->size(), control.jobs, [&](size_t i) { return bakeFamily(plan, (*missing)[i]); },
        [&](size_t i, BakedFamily&& baked) {
          result = baked ? writing.take((*missing)[i], std::move(*baked), parents)
                         : Result<void>(tl::unexpected(baked.error()));
          writing.report(level, missing->size() - i - 1);
          return result.has_value() && !writing.shouldStop();
        });
    if (!result) return tl::unexpected(result.error());
    if (auto committed = writing.commit(); !committed) return tl::unexpected(committed.error());
    if (writing.shouldStop()) return BakeOutcome::interrupted;
    families = familiesOf(std::move(parents));
  }
  if (auto finished = writer.finish(); !finished) return tl::unexpected(finished.error());
  return BakeOutcome::complete;
}

}  // namespace eye
