// The terrain database (.eyt): one SQLite file. docs/TILE_FORMAT.md has the schema.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "terrain/chunk.h"
#include "terrain/chunk_codec.h"

namespace eye {

inline constexpr int kSchemaVersion = 2;  // 2: meshes have clusters

// Of the whole database; written once when it is created, `complete` when the bake ends.
struct DatabaseInfo {
  int schemaVersion = kSchemaVersion;
  int maxLevel = 0;
  double finestErrorM = 0;  // the tolerance of the finest meshes; see BakePlan::toleranceM for the levels above
  int textureSize = 0;      // texels along a chunk's edge, a power of two in 16..2048
  TileBounds dataBounds{};  // where the sources have data
  std::string description;  // sources and settings, for `info` and to refuse a --resume with others
  bool complete = false;
};

struct StoredChunk {
  ChunkMeta meta;
  Blob mesh;
  Blob imagery;  // empty where meta.hasImagery is false
};

// Thread: any one at a time. Every write is inside a transaction: kill -9 loses at most the open one. A write that
// fails (a full disk, say) rolls the whole transaction back, and what follows in it fails too, up to begin().
class DatabaseWriter {
 public:
  // Fails where the file exists, unless it is opened for resuming, which checks that info's settings are the same.
  static Result<DatabaseWriter> create(const std::string& path, const DatabaseInfo& info);
  static Result<DatabaseWriter> resume(const std::string& path, const DatabaseInfo& info);
  ~DatabaseWriter();
  DatabaseWriter(DatabaseWriter&&) noexcept;
  DatabaseWriter& operator=(DatabaseWriter&&) noexcept;

  Result<void> begin();
  Result<void> commit();
  Result<void> putChunk(const StoredChunk& chunk);  // inserts or replaces
  // Call after the children are in: stores the parent's child count and raises its and its ancestors' errors so that no
  // child's exceeds its parent's.
  Result<void> setChildren(const TileKey& parent, int childCount);
  // In the file and undamaged: false also where its bytes fail their checksum, so that --resume mends what is broken.
  Result<bool> contains(const TileKey& key) const;
  Result<std::optional<ChunkMeta>> readMeta(const TileKey& key) const;
  // Marks the bake complete and checkpoints: with the writer gone, the file alone is the database.
  Result<void> finish();

 private:
  struct Impl;
  explicit DatabaseWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

// Thread: one at a time; open one reader a thread. The file is opened read-only and is not trusted.
class DatabaseReader {
 public:
  static Result<DatabaseReader> open(const std::string& path);
  ~DatabaseReader();
  DatabaseReader(DatabaseReader&&) noexcept;
  DatabaseReader& operator=(DatabaseReader&&) noexcept;

  const DatabaseInfo& info() const;
  const std::string& path() const;
  // notFound where the tile is not in the file, badData (with the tile's code and what to do) where its bytes are
  // damaged.
  Result<StoredChunk> read(const TileKey& key) const;
  Result<ChunkMeta> readMeta(const TileKey& key) const;
  // Bytes of blobs read so far.
  uint64_t bytesRead() const;

  struct LevelSummary {
    int level = 0;
    uint64_t tiles = 0, meshBytes = 0, imageryBytes = 0, leaves = 0;
    double maxErrorM = 0, meanErrorM = 0;
  };
  Result<std::vector<LevelSummary>> levels() const;
  // Every checksum and invariant: decodable blobs, bounds, children present where counted, errors monotone, all eight
  // roots. The first damage is the error. `progress(done, total)` is called now and then.
  Result<void> verify(const std::function<void(uint64_t, uint64_t)>& progress) const;
  // Every tile, coarse levels first.
  Result<void> forEach(const std::function<Result<void>(const ChunkMeta&)>& visit) const;

 private:
  struct Impl;
  explicit DatabaseReader(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace eye
