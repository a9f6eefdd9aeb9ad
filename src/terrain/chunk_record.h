// A chunk's metadata as a row of the table `chunk`: what is stored, what is summed, and what is believed.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "base/error.h"
#include "terrain/chunk.h"
#include "terrain/sqlite_handle.h"

namespace eye {

// What the metadata says about a blob, so that each of the two can be checked by itself.
struct BlobSum {
  uint32_t bytes = 0;
  uint32_t crc32 = 0;
  bool operator==(const BlobSum&) const = default;
};
BlobSum blobSum(std::span<const std::byte> blob);

struct ChunkRecord {
  ChunkMeta meta;
  BlobSum mesh, imagery;
};

// The columns of `chunk` in the order of bindRecord and readRecord, and as many parameters.
extern const char* const kRecordColumns;
extern const char* const kRecordParameters;
inline constexpr int kRecordColumnCount = 12 + 23 + 1;  // integers, reals, checksum

// `meta` must be believable (checkMeta).
void bindRecord(SqliteStatement& statement, const ChunkRecord& record);
// Errors say what is wrong with the row, without file and tile.
Result<ChunkRecord> readRecord(const SqliteStatement& row);

// Everything about a chunk's metadata that can be checked without its blobs: finite numbers, ranges, bounds that lie
// where the tile lies.
Result<void> checkMeta(const ChunkMeta& meta);

// Codes above 2^63 (level 19) are negative in SQLite.
inline int64_t signedCode(const TileKey& key) {
  return static_cast<int64_t>(key.code());
}

// "FILE: tile L7 octant 0 row 12 column 3 (code 0x...): WHAT; bake it again with --resume or restore the file"
Error damagedTile(const std::string& path, const TileKey& key, const Error& what);

}  // namespace eye
