#include "bake/merge.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bake/shard.h"
#include "terrain/database.h"

namespace eye {
namespace fs = std::filesystem;

namespace {

constexpr size_t kBatchTiles = 4096;  // a transaction

// The unshared bake's information; an error unless the inputs are all of its shards.
Result<DatabaseInfo> commonInfo(const std::vector<DatabaseReader>& shards) {
  DatabaseInfo common = shards.front().info();
  std::vector<const DatabaseReader*> byIndex;
  for (const DatabaseReader& reader : shards) {
    const DatabaseInfo& info = reader.info();
    const auto described = shardFrom(info.description);
    if (!described) {
      return fail(ErrorKind::usage,
                  fmt::format("{}: is no shard; merge joins what eyepoint-bake --shard I/N has made", reader.path()));
    }
    if (!info.complete) {
      return fail(ErrorKind::usage, fmt::format("{}: shard {}/{} is not finished; repeat its command with --resume",
                                                reader.path(), described->shard.index, described->shard.count));
    }
    if (byIndex.empty()) {
      common.description = described->sources;
      byIndex.resize(static_cast<size_t>(described->shard.count), nullptr);
    }
    const bool same = described->sources == common.description &&
                      static_cast<size_t>(described->shard.count) == byIndex.size() &&
                      info.maxLevel == common.maxLevel && info.finestErrorM == common.finestErrorM &&
                      info.textureSize == common.textureSize &&
                      std::memcmp(&info.dataBounds, &common.dataBounds, sizeof(TileBounds)) == 0;
    if (!same) {
      return fail(ErrorKind::usage, fmt::format("{}: is of another bake than {} (other sources, settings or number of "
                                                "shards); merge the shards of one bake",
                                                reader.path(), shards.front().path()));
    }
    const DatabaseReader*& place = byIndex[static_cast<size_t>(described->shard.index - 1)];
    if (place != nullptr) {
      return fail(ErrorKind::usage, fmt::format("{}: is shard {}/{}, as {} is; name each shard once", reader.path(),
                                                described->shard.index, described->shard.count, place->path()));
    }
    place = &reader;
  }
  std::vector<size_t> missing;
  for (size_t i = 0; i < byIndex.size(); ++i)
    if (byIndex[i] == nullptr) missing.push_back(i + 1);
  if (!missing.empty()) {
    return fail(ErrorKind::usage,
                fmt::format("shards {} of {} are missing; name them too", fmt::join(missing, ", "), byIndex.size()));
  }
  return common;
}

class Merge {
 public:
  Merge(const std::vector<DatabaseReader>& shards, DatabaseWriter& writer) : shards_(shards), writer_(writer) {}

  // Of the tiles that several shards have, the error and the number of children are what their descendants made of
  // them: the greatest of all shards is what all descendants together would have made.
  Result<void> take(const DatabaseReader& shard, const ChunkMeta& meta) {
    Result<StoredChunk> chunk = shard.read(meta.key);
    if (!chunk) return tl::unexpected(chunk.error());
    const auto earlier = writer_.readMeta(meta.key);
    if (!earlier) return tl::unexpected(earlier.error());
    if (*earlier) {
      const Result<StoredChunk> other = shards_.front().read(meta.key);
      if (!other || other->mesh != chunk->mesh || other->imagery != chunk->imagery) {
        return fail(ErrorKind::badData,
                    fmt::format("{}: tile {} differs from that of {}; the sources have changed between the bakes",
                                shard.path(), meta.key.name(), shards_.front().path()));
      }
      chunk->meta.geometricErrorM = std::max(chunk->meta.geometricErrorM, (*earlier)->geometricErrorM);
      chunk->meta.childCount = std::max(chunk->meta.childCount, (*earlier)->childCount);
    }
    if (pending_ == 0) {
      if (Result<void> begun = writer_.begin(); !begun) return begun;
    }
    if (Result<void> put = writer_.putChunk(*chunk); !put) return put;
    return ++pending_ >= kBatchTiles ? commit() : Result<void>{};
  }

  Result<void> commit() {
    if (pending_ == 0) return {};
    pending_ = 0;
    return writer_.commit();
  }

 private:
  const std::vector<DatabaseReader>& shards_;
  DatabaseWriter& writer_;
  size_t pending_ = 0;
};

Result<void> mergeInto(const std::string& path, const std::vector<DatabaseReader>& shards, const DatabaseInfo& info,
                       const std::function<void(uint64_t, uint64_t)>& progress) {
  Result<DatabaseWriter> writer = DatabaseWriter::create(path, info);
  if (!writer) return tl::unexpected(writer.error());
  uint64_t total = 0, done = 0;
  for (const DatabaseReader& shard : shards) {
    const auto levels = shard.levels();
    if (!levels) return tl::unexpected(levels.error());
    for (const DatabaseReader::LevelSummary& level : *levels) total += level.tiles;
  }
  Merge merge(shards, *writer);
  for (const DatabaseReader& shard : shards) {
    const Result<void> taken = shard.forEach([&](const ChunkMeta& meta) {
      progress(done++, total);
      return merge.take(shard, meta);
    });
    if (!taken) return taken;
  }
  if (Result<void> committed = merge.commit(); !committed) return committed;
  return writer->finish();
}

// With its log, which a killed merge leaves.
void removeDatabase(const std::string& path) {
  std::error_code ignored;
  for (const char* suffix : {"", "-wal", "-shm"}) fs::remove(path + suffix, ignored);
}

}  // namespace

Result<void> mergeShards(const std::string& out, const std::vector<std::string>& inputs,
                         const std::function<void(uint64_t, uint64_t)>& progress) {
  std::error_code error;
  if (fs::exists(out, error)) return fail(ErrorKind::usage, out + ": exists already; delete it first");
  const std::string part = out + ".part";
  std::vector<DatabaseReader> shards;
  for (const std::string& input : inputs) {
    if (fs::equivalent(input, part, error))
      return fail(ErrorKind::usage,
                  fmt::format("{}: merging into {} would write over it; rename it first", input, out));
    Result<DatabaseReader> reader = DatabaseReader::open(input);
    if (!reader) return tl::unexpected(reader.error());
    shards.push_back(std::move(*reader));
  }
  const Result<DatabaseInfo> info = commonInfo(shards);
  if (!info) return tl::unexpected(info.error());
  removeDatabase(part);
  Result<void> merged = mergeInto(part, shards, *info, progress);
  if (merged) {
    fs::rename(part, out, error);
    if (error)
      merged = fail(ErrorKind::io, fmt::format("{}: cannot be renamed to {} ({})", part, out, error.message()));
  }
  if (!merged) removeDatabase(part);
  return merged;
}

}  // namespace eye
