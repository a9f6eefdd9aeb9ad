// The reading half of database.h.
#include <filesystem>

#include <fmt/format.h>
#include <sqlite3.h>

#include "terrain/chunk_record.h"
#include "terrain/chunk_verify.h"
#include "terrain/database.h"
#include "terrain/database_schema.h"
#include "terrain/sqlite_handle.h"

namespace eye {

struct DatabaseReader::Impl {
  std::string path;
  DatabaseInfo info;
  uint64_t bytesRead = 0;
  SqliteConnection database;
  SqliteStatement getMeta, getAll;

  Error damaged(const TileKey& key, const std::string& what) const {
    return damagedTile(path, key, {ErrorKind::badData, what});
  }
  Error missing(const TileKey& key) const {
    return {ErrorKind::notFound,
            fmt::format("{}: tile {} (code {:#x}) is not in the file", path, key.name(), key.code())};
  }
  // Runs `get` for a tile and leaves it at its row.
  Result<ChunkRecord> find(SqliteStatement& get, const TileKey& key);
  Result<void> forEach(const std::function<Result<void>(const ChunkRecord&)>& visit);
  Result<void> forEachBetween(int64_t firstCode, int64_t lastCode,
                              const std::function<Result<void>(const ChunkRecord&)>& visit);
  Result<void> checkStructure();
  Result<void> checkTile(const DatabaseReader& reader, const ChunkMeta& meta) const;
  Result<void> verify(const DatabaseReader& reader, const std::function<void(uint64_t, uint64_t)>& progress);
};

namespace {

// Small: tiles are kept decoded by whoever reads them, so only the inner pages of the trees are worth keeping.
constexpr const char* kReaderPragmas = "PRAGMA query_only = ON; PRAGMA cache_size = -2048";

Result<SqliteConnection> openWith(const std::string& name, int flags, const std::string& path) {
  Result<SqliteConnection> database = SqliteConnection::open(name, flags | SQLITE_OPEN_NOMUTEX, path);
  if (!database) return database;
  if (const Result<void> ok = harden(*database); !ok) return tl::unexpected(ok.error());
  // The first access to the file itself.
  if (const Result<void> ok = database->execute(kReaderPragmas); !ok) return tl::unexpected(ok.error());
  if (const Result<void> ok = checkSchema(*database, path); !ok) return tl::unexpected(ok.error());
  return database;
}

// A file that was copied out of a bake is marked as having a log; where none can be made (a read-only medium) and none
// is there, the file alone is the database and nobody changes it.
Result<SqliteConnection> openReadOnly(const std::string& path) {
  Result<SqliteConnection> database = openWith(path, SQLITE_OPEN_READONLY, path);
  if (database || database.error().kind != ErrorKind::io) return database;
  std::error_code error;
  const uintmax_t logBytes = std::filesystem::file_size(path + "-wal", error);
  if (!error && logBytes > 0) return database;
  Result<SqliteConnection> immutable =
      openWith(sqliteUri(path, "immutable=1"), SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, path);
  return immutable ? std::move(immutable) : std::move(database);
}

}  // namespace

Result<ChunkRecord> DatabaseReader::Impl::find(SqliteStatement& get, const TileKey& key) {
  get.bindInteger(0, signedCode(key));
  const Result<bool> row = get.step();
  if (!row) return tl::unexpected(row.error());
  if (!*row) return tl::unexpected(missing(key));
  Result<ChunkRecord> record = readRecord(get);
  if (!record) return tl::unexpected(damagedTile(path, key, record.error()));
  if (record->meta.key != key) return tl::unexpected(damaged(key, "another tile is in its place"));
  if (key.level() > info.maxLevel) return tl::unexpected(damaged(key, "its level is above the database's highest"));
  return record;
}

Result<void> DatabaseReader::Impl::forEachBetween(int64_t firstCode, int64_t lastCode,
                                                  const std::function<Result<void>(const ChunkRecord&)>& visit) {
  // A statement of its own: `visit` may read, or walk the file again.
  Result<SqliteStatement> rows = database.prepare(std::string("SELECT ") + kRecordColumns +
                                                  " FROM chunk WHERE chunk.code BETWEEN ? AND ? ORDER BY chunk.code");
  if (!rows) return tl::unexpected(rows.error());
  rows->bindInteger(0, firstCode);
  rows->bindInteger(1, lastCode);
  std::optional<int64_t> previous;
  for (;;) {
    const Result<bool> row = rows->step();
    if (!row) return tl::unexpected(row.error());
    if (!*row) return {};
    const std::optional<int64_t> code = rows->integer(0);
    const Result<TileKey> key = TileKey::fromCode(static_cast<uint64_t>(code.value_or(0)));
    if (!code || !key || (previous && *previous >= *code)) {
      return fail(ErrorKind::badData,
                  fmt::format("{}: a row of code {:#x} is no tile or out of order; restore the file "
                              "or bake it again",
                              path, static_cast<uint64_t>(code.value_or(0))));
    }
    previous = code;
    const Result<ChunkRecord> record = readRecord(*rows);
    if (!record) return tl::unexpected(damagedTile(path, *key, record.error()));
    if (key->level() > info.maxLevel) {
      return tl::unexpected(damaged(*key, "its level is above the database's highest"));
    }
    if (Result<void> ok = visit(*record); !ok) return ok;
  }
}

// A code has one leading 1 and three bits a level, so codes in ascending order are coarse levels first; those of level
// 19 are negative to SQLite and come last.
Result<void> DatabaseReader::Impl::forEach(const std::function<Result<void>(const ChunkRecord&)>& visit) {
  if (Result<void> ok = forEachBetween(0, INT64_MAX, visit); !ok) return ok;
  return forEachBetween(INT64_MIN, -1, visit);
}

Result<void> DatabaseReader::Impl::checkStructure() {
  Result<SqliteStatement> check = database.prepare("PRAGMA quick_check(1)");
  if (!check) return tl::unexpected(check.error());
  const Result<bool> row = check->step();
  if (!row) return tl::unexpected(row.error());
  const std::string verdict = *row ? check->text(0).value_or("?") : "?";
  if (verdict != "ok") {
    std::string line = verdict;
    std::replace(line.begin(), line.end(), '\n', ' ');
    return fail(ErrorKind::badData, path + ": the file is damaged (" + line + "); restore it or bake it again");
  }
  const Result<int64_t> unpaired = database.queryInteger(
      "SELECT (SELECT count(*) FROM chunk WHERE code NOT IN (SELECT code FROM chunk_data)) + "
      "(SELECT count(*) FROM chunk_data WHERE code NOT IN (SELECT code FROM chunk))");
  if (!unpaired) return tl::unexpected(unpaired.error());
  if (*unpaired != 0) {
    return fail(ErrorKind::badData, fmt::format("{}: {} tiles have metadata or data only; bake it again with --resume "
                                                "or restore the file",
                                                path, *unpaired));
  }
  return {};
}

Result<void> DatabaseReader::Impl::checkTile(const DatabaseReader& reader, const ChunkMeta& meta) const {
  const Result<StoredChunk> chunk = reader.read(meta.key);
  if (!chunk) return tl::unexpected(chunk.error());
  if (const Result<void> ok = checkContents(*chunk, info.textureSize); !ok) {
    return tl::unexpected(damagedTile(path, meta.key, ok.error()));
  }
  if (meta.childCount > 0) {
    for (const TileKey& childKey : meta.key.children()) {
      const Result<ChunkMeta> child = reader.readMeta(childKey);
      if (!child) return tl::unexpected(child.error());
      if (child->geometricErrorM > meta.geometricErrorM) {
        return tl::unexpected(damaged(childKey, "its error exceeds its parent's"));
      }
    }
  }
  // A bake that was interrupted may hold tiles that their parents do not count yet.
  if (const std::optional<TileKey> parentKey = meta.key.parent(); parentKey && info.complete) {
    const Result<ChunkMeta> parent = reader.readMeta(*parentKey);
    if (!parent) return tl::unexpected(parent.error());
    if (parent->childCount == 0) return tl::unexpected(damaged(meta.key, "its parent does not count it"));
  }
  return {};
}

Result<void> DatabaseReader::Impl::verify(const DatabaseReader& reader,
                                          const std::function<void(uint64_t, uint64_t)>& progress) {
  constexpr uint64_t kProgressEvery = 256;
  if (Result<void> ok = checkStructure(); !ok) return ok;
  const Result<int64_t> rows = database.queryInteger("SELECT count(*) FROM chunk");
  if (!rows) return tl::unexpected(rows.error());
  for (int octant = 0; octant < kOctants; ++octant) {
    const Result<ChunkMeta> root = reader.readMeta(TileKey::octantRoot(octant));
    if (!root) return tl::unexpected(root.error());
  }
  const uint64_t total = static_cast<uint64_t>(*rows);
  uint64_t done = 0;
  Result<void> walked = forEach([&](const ChunkRecord& record) -> Result<void> {
    if (Result<void> ok = checkTile(reader, record.meta); !ok) return ok;
    if (progress && ++done % kProgressEvery == 0) progress(done, total);
    return {};
  });
  if (walked && progress) progress(total, total);
  return walked;
}

DatabaseReader::DatabaseReader(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
DatabaseReader::~DatabaseReader() = default;
DatabaseReader::DatabaseReader(DatabaseReader&&) noexcept = default;
DatabaseReader& DatabaseReader::operator=(DatabaseReader&&) noexcept = default;

Result<DatabaseReader> DatabaseReader::open(const std::string& path) {
  if (const Result<void> ok = checkFile(path); !ok) return tl::unexpected(ok.error());
  auto impl = std::make_unique<Impl>();
  impl->path = path;
  Result<SqliteConnection> database = openReadOnly(path);
  if (!database) return tl::unexpected(database.error());
  impl->database = std::move(*database);
  Result<DatabaseInfo> info = readInfo(impl->database, path);
  if (!info) return tl::unexpected(info.error());
  impl->info = std::move(*info);
  const std::string columns = kRecordColumns;
  Result<SqliteStatement> getMeta = impl->database.prepare("SELECT " + columns + " FROM chunk WHERE chunk.code = ?");
  if (!getMeta) return tl::unexpected(getMeta.error());
  Result<SqliteStatement> getAll = impl->database.prepare(
      "SELECT " + columns + ", mesh, imagery FROM chunk LEFT JOIN chunk_data USING (code) WHERE chunk.code = ?");
  if (!getAll) return tl::unexpected(getAll.error());
  impl->getMeta = std::move(*getMeta);
  impl->getAll = std::move(*getAll);
  return DatabaseReader(std::move(impl));
}

const DatabaseInfo& DatabaseReader::info() const {
  return impl_->info;
}
const std::string& DatabaseReader::path() const {
  return impl_->path;
}
uint64_t DatabaseReader::bytesRead() const {
  return impl_->bytesRead;
}

Result<StoredChunk> DatabaseReader::read(const TileKey& key) const {
  Impl& impl = *impl_;
  const SqliteReset reset(impl.getAll);
  const Result<ChunkRecord> record = impl.find(impl.getAll, key);
  if (!record) return tl::unexpected(record.error());
  const auto mesh = impl.getAll.blob(kRecordColumnCount), imagery = impl.getAll.blob(kRecordColumnCount + 1);
  if (!mesh || !imagery) return tl::unexpected(impl.damaged(key, "its data is missing"));
  if (blobSum(*mesh) != record->mesh || blobSum(*imagery) != record->imagery) {
    return tl::unexpected(impl.damaged(key, "checksum does not match"));
  }
  if (imagery->empty() == record->meta.hasImagery) {
    return tl::unexpected(impl.damaged(key, "it says otherwise about imagery"));
  }
  impl.bytesRead += mesh->size() + imagery->size();
  return StoredChunk{record->meta, Blob(mesh->begin(), mesh->end()), Blob(imagery->begin(), imagery->end())};
}

Result<ChunkMeta> DatabaseReader::readMeta(const TileKey& key) const {
  const SqliteReset reset(impl_->getMeta);
  const Result<ChunkRecord> record = impl_->find(impl_->getMeta, key);
  if (!record) return tl::unexpected(record.error());
  return record->meta;
}

Result<void> DatabaseReader::forEach(const std::function<Result<void>(const ChunkMeta&)>& visit) const {
  return impl_->forEach([&visit](const ChunkRecord& record) { return visit(record.meta); });
}

Result<std::vector<DatabaseReader::LevelSummary>> DatabaseReader::levels() const {
  std::vector<LevelSummary> levels;
  const Result<void> walked = impl_->forEach([&levels](const ChunkRecord& record) -> Result<void> {
    const ChunkMeta& meta = record.meta;
    if (levels.empty() || levels.back().level != meta.key.level()) levels.push_back({.level = meta.key.level()});
    LevelSummary& level = levels.back();
    ++level.tiles;
    level.meshBytes += record.mesh.bytes;
    level.imageryBytes += record.imagery.bytes;
    level.leaves += meta.childCount == 0 ? 1 : 0;
    level.maxErrorM = std::max(level.maxErrorM, meta.geometricErrorM);
    level.meanErrorM += meta.geometricErrorM;  // the sum so far
    return {};
  });
  if (!walked) return tl::unexpected(walked.error());
  for (LevelSummary& level : levels) level.meanErrorM /= static_cast<double>(level.tiles);
  return levels;
}

Result<void> DatabaseReader::verify(const std::function<void(uint64_t, uint64_t)>& progress) const {
  // In one transaction: a bake that goes on meanwhile does not change what is looked at.
  if (Result<void> ok = impl_->database.execute("BEGIN"); !ok) return ok;
  Result<void> verdict = impl_->verify(*this, progress);
  (void)impl_->database.execute("COMMIT");  // of nothing but reading: its failure says nothing about the file
  return verdict;
}

}  // namespace eye
