#include "terrain/database_schema.h"

#include <bit>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <variant>

#include <fmt/format.h>
#include <sqlite3.h>

#include "base/byte_writer.h"
#include "terrain/chunk_record.h"

namespace eye {
namespace {

constexpr int64_t kApplicationId = 0x45595054;  // "EYPT"
// Above the largest row: imagery of 2048 x 2048 texels that does not compress (12.6 MB) and a mesh of 65535 vertices.
constexpr int kMaxValueBytes = 16 << 20;
constexpr size_t kMaxDescriptionBytes = 64 << 10;

// 8 KiB pages hold most meshes beside a pointer to the imagery's overflow pages; 16 KiB would waste half a page a tile,
// 4 KiB would chain twice as many.
constexpr const char* kCreatePragmas = "PRAGMA page_size = 8192; PRAGMA application_id = 0x45595054;";

struct Table {
  const char* name;
  const char* sql;
};
// Metadata is apart from blobs, so that levels, trees and errors are walked without touching the pictures. Sorted.
constexpr Table kTables[] = {
    {"chunk",
     "CREATE TABLE chunk (code INTEGER PRIMARY KEY, level INTEGER NOT NULL, child_count INTEGER NOT NULL, "
     "has_imagery INTEGER NOT NULL, lattice_shift INTEGER NOT NULL, origin_x INTEGER NOT NULL, origin_y INTEGER NOT "
     "NULL, origin_z INTEGER NOT NULL, mesh_bytes INTEGER NOT NULL, imagery_bytes INTEGER NOT NULL, mesh_crc32 INTEGER "
     "NOT NULL, imagery_crc32 INTEGER NOT NULL, error_m REAL NOT NULL, texel_error_m REAL NOT NULL, min_height_m REAL "
     "NOT NULL, max_height_m REAL NOT NULL, sphere_x_m REAL NOT NULL, sphere_y_m REAL NOT NULL, sphere_z_m REAL NOT "
     "NULL, sphere_radius_m REAL NOT NULL, box_x_m REAL NOT NULL, box_y_m REAL NOT NULL, box_z_m REAL NOT NULL, "
     "box_axis0_x_m REAL NOT NULL, box_axis0_y_m REAL NOT NULL, box_axis0_z_m REAL NOT NULL, box_axis1_x_m REAL NOT "
     "NULL, box_axis1_y_m REAL NOT NULL, box_axis1_z_m REAL NOT NULL, box_axis2_x_m REAL NOT NULL, box_axis2_y_m REAL "
     "NOT NULL, box_axis2_z_m REAL NOT NULL, horizon_x REAL NOT NULL, horizon_y REAL NOT NULL, horizon_z REAL NOT "
     "NULL, meta_crc32 INTEGER NOT NULL) STRICT"},
    {"chunk_data",
     "CREATE TABLE chunk_data (code INTEGER PRIMARY KEY, mesh BLOB NOT NULL, imagery BLOB NOT NULL) STRICT"},
    {"info", "CREATE TABLE info (key TEXT PRIMARY KEY, value ANY NOT NULL) STRICT, WITHOUT ROWID"},
};

tl::unexpected<Error> damaged(const std::string& path, const std::string& what) {
  return fail(ErrorKind::badData, path + ": " + what + "; restore the file or bake it again");
}

// Over every value of `info`, in the order of docs/TILE_FORMAT.md.
int64_t infoChecksum(const DatabaseInfo& info) {
  ByteWriter bytes(std::endian::little);
  bytes.i64(info.maxLevel);
  bytes.i64(info.textureSize);
  bytes.i64(info.complete ? 1 : 0);
  const TileBounds& b = info.dataBounds;
  for (const double real : {info.finestErrorM, b.southDeg, b.northDeg, b.westDeg, b.eastDeg}) bytes.f64(real + 0.0);
  bytes.bytes(std::as_bytes(std::span(info.description)));
  return blobSum(bytes.data()).crc32;
}

using Value = std::variant<std::monostate, int64_t, double, std::string>;

Result<std::map<std::string, Value>> readPairs(SqliteConnection& database, const std::string& path) {
  // Ten short rows are what there should be; a hostile file gets no more memory than this.
  Result<SqliteStatement> rows = database.prepare(
      "SELECT key, value FROM info WHERE length(CAST(key AS BLOB)) < 64 AND length(CAST(value AS BLOB)) <= 65536 "
      "LIMIT 32");
  if (!rows) return tl::unexpected(rows.error());
  std::map<std::string, Value> pairs;
  for (;;) {
    const Result<bool> row = rows->step();
    if (!row) return tl::unexpected(row.error());
    if (!*row) return pairs;
    const std::optional<std::string> key = rows->text(0);
    if (!key) return damaged(path, "a key of its information is no text");
    Value& value = pairs[*key];
    if (const auto integer = rows->integer(1)) value = *integer;
    if (const auto real = rows->real(1)) value = *real;
    if (auto text = rows->text(1)) value = std::move(*text);
  }
}

}  // namespace

Result<void> harden(SqliteConnection& database) {
  sqlite3* const raw = database.raw();
  sqlite3_limit(raw, SQLITE_LIMIT_LENGTH, kMaxValueBytes);
  sqlite3_limit(raw, SQLITE_LIMIT_ATTACHED, 0);
  sqlite3_db_config(raw, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(raw, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(raw, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  sqlite3_db_config(raw, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
  // No memory mapping: a file that is cut short while it is read must be an error and no signal.
  return database.execute("PRAGMA cell_size_check = ON; PRAGMA mmap_size = 0; PRAGMA temp_store = MEMORY");
}

Result<void> createSchema(SqliteConnection& database, const DatabaseInfo& info) {
  std::string sql = std::string(kCreatePragmas) + fmt::format("PRAGMA user_version = {}; BEGIN;", kSchemaVersion);
  for (const Table& table : kTables) sql += std::string(table.sql) + ";";
  if (Result<void> ok = database.execute(sql.c_str()); !ok) return ok;
  if (Result<void> ok = writeInfo(database, info); !ok) return ok;
  return database.execute("COMMIT");
}

Result<void> checkSchema(SqliteConnection& database, const std::string& path) {
  const Result<int64_t> applicationId = database.queryInteger("PRAGMA application_id");
  if (!applicationId) return tl::unexpected(applicationId.error());
  if (*applicationId != kApplicationId) {
    return fail(ErrorKind::badData, path + ": is an SQLite file but no terrain database; make one with eyepoint-bake");
  }
  const Result<int64_t> version = database.queryInteger("PRAGMA user_version");
  if (!version) return tl::unexpected(version.error());
  if (*version > kSchemaVersion) {
    return fail(ErrorKind::unsupported, fmt::format("{}: is of schema version {}, newer than this program's {}; use a "
                                                    "newer Eyepoint or bake it again",
                                                    path, *version, kSchemaVersion));
  }
  if (*version != kSchemaVersion) {
    return fail(ErrorKind::unsupported, fmt::format("{}: is of schema version {}, this program reads {}; bake it again",
                                                    path, *version, kSchemaVersion));
  }
  Result<SqliteStatement> rows = database.prepare("SELECT name, sql FROM sqlite_schema ORDER BY name LIMIT 10");
  if (!rows) return tl::unexpected(rows.error());
  for (const Table& table : kTables) {
    const Result<bool> row = rows->step();
    if (!row) return tl::unexpected(row.error());
    if (!*row || rows->text(0) != table.name || rows->text(1) != table.sql) {
      return damaged(path,
                     fmt::format("its tables are not those of a terrain database (`{}` was expected)", table.name));
    }
  }
  const Result<bool> more = rows->step();
  if (!more) return tl::unexpected(more.error());
  if (*more) {
    return damaged(path, fmt::format("has something beside the tables of a terrain database (`{}`)",
                                     rows->text(0).value_or("nameless")));
  }
  return {};
}

Result<void> writeInfo(SqliteConnection& database, const DatabaseInfo& info) {
  Result<SqliteStatement> put = database.prepare("INSERT OR REPLACE INTO info VALUES (?, ?)");
  if (!put) return tl::unexpected(put.error());
  const TileBounds& b = info.dataBounds;
  const std::pair<const char*, Value> pairs[] = {
      {"max_level", int64_t{info.maxLevel}}, {"texture_size", int64_t{info.textureSize}},
      {"complete", int64_t{info.complete}},  {"finest_error_m", info.finestErrorM + 0.0},
      {"south_deg", b.southDeg + 0.0},       {"north_deg", b.northDeg + 0.0},
      {"west_deg", b.westDeg + 0.0},         {"east_deg", b.eastDeg + 0.0},
      {"description", info.description},     {"checksum_crc32", infoChecksum(info)},
  };
  for (const auto& [key, value] : pairs) {
    put->bindText(0, key);
    if (const auto* integer = std::get_if<int64_t>(&value)) put->bindInteger(1, *integer);
    if (const auto* real = std::get_if<double>(&value)) put->bindReal(1, *real);
    if (const auto* text = std::get_if<std::string>(&value)) put->bindText(1, *text);
    if (const Result<bool> done = put->step(); !done) return tl::unexpected(done.error());
  }
  return {};
}

Result<DatabaseInfo> readInfo(SqliteConnection& database, const std::string& path) {
  const Result<std::map<std::string, Value>> pairs = readPairs(database, path);
  if (!pairs) return tl::unexpected(pairs.error());
  std::string missing;
  const auto find = [&]<class T>(const char* key, T) -> T {
    const auto at = pairs->find(key);
    const T* const value = at == pairs->end() ? nullptr : std::get_if<T>(&at->second);
    if (value == nullptr) missing = key;
    return value == nullptr ? T{} : *value;
  };
  const auto integer = [&](const char* key) { return find(key, int64_t{}); };
  const auto real = [&](const char* key) { return find(key, double{}); };
  const int64_t maxLevel = integer("max_level"), textureSize = integer("texture_size");
  DatabaseInfo info;
  info.complete = integer("complete") != 0;
  info.finestErrorM = real("finest_error_m");
  info.dataBounds = {real("south_deg"), real("north_deg"), real("west_deg"), real("east_deg")};
  info.description = find("description", std::string{});
  const int64_t checksum = integer("checksum_crc32");
  if (!missing.empty()) return damaged(path, fmt::format("`{}` is missing from its information", missing));
  info.maxLevel = static_cast<int>(std::clamp<int64_t>(maxLevel, -1, kMaxLevel + 1));
  info.textureSize = static_cast<int>(std::clamp<int64_t>(textureSize, -1, 1 << 20));
  if (const Result<void> ok = checkInfo(info); !ok) return damaged(path, ok.error().message);
  if (checksum != infoChecksum(info)) return damaged(path, "the checksum of its information does not match");
  return info;
}

Result<void> checkInfo(const DatabaseInfo& info) {
  if (info.maxLevel < 0 || info.maxLevel > kMaxLevel) {
    return fail(ErrorKind::badData, fmt::format("the highest level must be 0 to {}", kMaxLevel));
  }
  if (!(std::isfinite(info.finestErrorM) && info.finestErrorM > 0)) {
    return fail(ErrorKind::badData, "the finest level's error must be above 0 m");
  }
  if (info.textureSize < 16 || info.textureSize > 2048 ||
      !std::has_single_bit(static_cast<unsigned>(info.textureSize))) {
    return fail(ErrorKind::badData, "the texture size must be a power of two from 16 to 2048");
  }
  const TileBounds& b = info.dataBounds;
  if (!(b.southDeg >= -90 && b.southDeg <= b.northDeg && b.northDeg <= 90 && b.westDeg >= -180 &&
        b.westDeg <= b.eastDeg && b.eastDeg <= 180)) {
    return fail(ErrorKind::badData, "the extent must lie within 90 S to 90 N and 180 W to 180 E");
  }
  if (info.description.size() > kMaxDescriptionBytes) {
    return fail(ErrorKind::badData, "the description of the sources is too long");
  }
  return {};
}

Result<void> checkFile(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) {
    return fail(ErrorKind::notFound, path + ": there is no such file; make one with eyepoint-bake");
  }
  if (status.type() == fs::file_type::directory) {
    return fail(ErrorKind::badData, path + ": is a folder, not a terrain database; name the .eyt file in it");
  }
  if (status.type() != fs::file_type::regular) {
    return fail(ErrorKind::io, path + ": cannot be read as a file" + (error ? " (" + error.message() + ")" : "") +
                                   "; check its name and the rights to it");
  }
  const uintmax_t bytes = fs::file_size(path, error);
  if (!error && bytes == 0) {
    return fail(ErrorKind::badData, path + ": is empty; delete it and bake it again");
  }
  return {};
}

}  // namespace eye
