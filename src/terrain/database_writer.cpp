// The writing half of database.h.
#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <sqlite3.h>
#include <unistd.h>

#include "terrain/chunk_record.h"
#include "terrain/database.h"
#include "terrain/database_schema.h"
#include "terrain/sqlite_handle.h"

namespace eye {

struct DatabaseWriter::Impl {
  std::string path;
  DatabaseInfo info;
  bool inTransaction = false;  // between begin() and commit(), also when SQLite has rolled it back since
  SqliteConnection database;
  SqliteStatement putMeta, putData, getMeta, getAll;

  Result<void> prepare();
  Result<void> checkTransaction() const;
  // Passes the error on after taking the whole transaction back, so that no half-written chunk can be committed.
  Result<void> rollBack(const Error& error);
  Result<void> write(const ChunkRecord& record);
  Result<std::optional<ChunkRecord>> find(const TileKey& key);
};

namespace {

Result<void> createEmptyFile(const std::string& path) {
  const int file = ::open(path.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, 0666);
  if (file >= 0) {
    ::close(file);
    return {};
  }
  const int code = errno;
  if (code == EEXIST) {
    return fail(ErrorKind::usage, path + ": exists already; go on with --resume, or delete it first");
  }
  return fail(
      code == ENOSPC ? ErrorKind::noSpace : ErrorKind::io,
      fmt::format("{}: cannot be created ({}); check the folder and the rights to it", path, std::strerror(code)));
}

// While a bake runs, the write-ahead log lets others read; a crash leaves every finished transaction.
Result<void> startLog(SqliteConnection& database) {
  return database.execute("PRAGMA journal_mode = WAL; PRAGMA synchronous = NORMAL");
}

// Puts the log into the file and removes it. A reader at work keeps this from happening; then file and log stay a valid
// database together, and whoever opens them next for writing joins them.
Result<void> endLog(SqliteConnection& database) {
  if (Result<void> ok = database.execute("PRAGMA wal_checkpoint(TRUNCATE)"); !ok) return ok;
  return database.execute("PRAGMA journal_mode = DELETE");
}

std::string settingsThatDiffer(const DatabaseInfo& stored, const DatabaseInfo& asked) {
  std::string differences;
  const auto compare = [&differences](const char* name, const auto& was, const auto& is) {
    if (was == is) return;
    differences += fmt::format("{}{} was {} and is now {}", differences.empty() ? "" : ", ", name, was, is);
  };
  const auto extent = [](const TileBounds& b) {
    return fmt::format("{},{},{},{}", b.westDeg, b.southDeg, b.eastDeg, b.northDeg);
  };
  compare("the highest level", stored.maxLevel, asked.maxLevel);
  compare("the finest error in metres", stored.finestErrorM, asked.finestErrorM);
  compare("the texture size", stored.textureSize, asked.textureSize);
  compare("the sources' extent", extent(stored.dataBounds), extent(asked.dataBounds));
  compare("the description of sources and settings", '"' + stored.description + '"', '"' + asked.description + '"');
  return differences;
}

}  // namespace

Result<void> DatabaseWriter::Impl::prepare() {
  const std::string columns = kRecordColumns;
  const struct {
    SqliteStatement* statement;
    std::string sql;
  } statements[] = {
      {&putMeta, std::string("INSERT OR REPLACE INTO chunk VALUES (") + kRecordParameters + ")"},
      {&putData, "INSERT OR REPLACE INTO chunk_data VALUES (?, ?, ?)"},
      {&getMeta, "SELECT " + columns + " FROM chunk WHERE chunk.code = ?"},
      {&getAll, "SELECT " + columns + ", mesh, imagery FROM chunk JOIN chunk_data USING (code) WHERE chunk.code = ?"},
  };
  for (const auto& [statement, sql] : statements) {
    Result<SqliteStatement> prepared = database.prepare(sql);
    if (!prepared) return tl::unexpected(prepared.error());
    *statement = std::move(*prepared);
  }
  return {};
}

Result<void> DatabaseWriter::Impl::checkTransaction() const {
  EYE_CHECK(inTransaction);
  if (database.inTransaction()) return {};
  return fail(ErrorKind::io, path + ": an earlier write failed and took its transaction back; go on with --resume");
}

Result<void> DatabaseWriter::Impl::rollBack(const Error& error) {
  // SQLite may have rolled back by itself (a full disk); then there is nothing left to roll back.
  if (database.inTransaction()) (void)database.execute("ROLLBACK");
  return tl::unexpected(error);
}

Result<void> DatabaseWriter::Impl::write(const ChunkRecord& record) {
  bindRecord(putMeta, record);
  const Result<bool> done = putMeta.step();
  if (!done) return rollBack(done.error());
  return {};
}

Result<std::optional<ChunkRecord>> DatabaseWriter::Impl::find(const TileKey& key) {
  getMeta.bindInteger(0, signedCode(key));
  const SqliteReset reset(getMeta);
  const Result<bool> row = getMeta.step();
  if (!row) return tl::unexpected(row.error());
  if (!*row) return std::optional<ChunkRecord>();
  Result<ChunkRecord> record = readRecord(getMeta);
  if (!record) return tl::unexpected(damagedTile(path, key, record.error()));
  return std::optional<ChunkRecord>(std::move(*record));
}

DatabaseWriter::DatabaseWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
DatabaseWriter::DatabaseWriter(DatabaseWriter&&) noexcept = default;

DatabaseWriter& DatabaseWriter::operator=(DatabaseWriter&& other) noexcept {
  std::swap(impl_, other.impl_);  // the other closes what was open here
  return *this;
}

DatabaseWriter::~DatabaseWriter() {
  if (!impl_) return;
  if (impl_->database.inTransaction()) (void)impl_->database.execute("ROLLBACK");
  (void)endLog(impl_->database);
}

Result<DatabaseWriter> DatabaseWriter::create(const std::string& path, const DatabaseInfo& info) {
  if (const Result<void> ok = checkInfo(info); !ok) {
    return fail(ErrorKind::usage, path + ": " + ok.error().message);
  }
  if (const Result<void> ok = createEmptyFile(path); !ok) return tl::unexpected(ok.error());
  auto impl = std::make_unique<Impl>();
  impl->path = path;
  impl->info = info;
  impl->info.schemaVersion = kSchemaVersion;
  impl->info.complete = false;
  Result<SqliteConnection> opened = SqliteConnection::open(path, SQLITE_OPEN_READWRITE | SQLITE_OPEN_NOMUTEX, path);
  if (!opened) return tl::unexpected(opened.error());
  impl->database = std::move(*opened);
  SqliteConnection& database = impl->database;
  if (const Result<void> ok = harden(database); !ok) return tl::unexpected(ok.error());
  if (const Result<void> ok = createSchema(database, impl->info); !ok) return tl::unexpected(ok.error());
  if (const Result<void> ok = startLog(database); !ok) return tl::unexpected(ok.error());
  if (const Result<void> ok = impl->prepare(); !ok) return tl::unexpected(ok.error());
  return DatabaseWriter(std::move(impl));
}

Result<DatabaseWriter> DatabaseWriter::resume(const std::string& path, const DatabaseInfo& info) {
  if (const Result<void> ok = checkFile(path); !ok) return tl::unexpected(ok.error());
  auto impl = std::make_unique<Impl>();
  impl->path = path;
  Result<SqliteConnection> opened = SqliteConnection::open(path, SQLITE_OPEN_READWRITE | SQLITE_OPEN_NOMUTEX, path);
  if (!opened) return tl::unexpected(opened.error());
  impl->database = std::move(*opened);
  SqliteConnection& database = impl->database;
  if (const Result<void> ok = harden(database); !ok) return tl::unexpected(ok.error());
  if (const Result<void> ok = checkSchema(database, path); !ok) return tl::unexpected(ok.error());
  Result<DatabaseInfo> stored = readInfo(database, path);
  if (!stored) return tl::unexpected(stored.error());
  if (const std::string differences = settingsThatDiffer(*stored, info); !differences.empty()) {
    return fail(ErrorKind::usage,
                fmt::format("{}: was begun with other settings ({}); use the same, or bake to another file", path,
                            differences));
  }
  impl->info = std::move(*stored);
  if (const Result<void> ok = startLog(database); !ok) return tl::unexpected(ok.error());
  if (const Result<void> ok = impl->prepare(); !ok) return tl::unexpected(ok.error());
  return DatabaseWriter(std::move(impl));
}

Result<void> DatabaseWriter::begin() {
  EYE_CHECK(!impl_->inTransaction || !impl_->database.inTransaction());
  impl_->inTransaction = false;
  if (Result<void> ok = impl_->database.execute("BEGIN IMMEDIATE"); !ok) return ok;
  impl_->inTransaction = true;
  return {};
}

Result<void> DatabaseWriter::commit() {
  if (Result<void> ok = impl_->checkTransaction(); !ok) return ok;
  if (const Result<void> ok = impl_->database.execute("COMMIT"); !ok) return impl_->rollBack(ok.error());
  impl_->inTransaction = false;
  return {};
}

Result<void> DatabaseWriter::putChunk(const StoredChunk& chunk) {
  Impl& impl = *impl_;
  if (Result<void> ok = impl.checkTransaction(); !ok) return ok;
  const TileKey& key = chunk.meta.key;
  Result<void> ok = checkMeta(chunk.meta);
  if (ok && key.level() > impl.info.maxLevel)
    ok = fail(ErrorKind::badData, "its level is above the database's highest");
  if (ok && chunk.imagery.empty() == chunk.meta.hasImagery)
    ok = fail(ErrorKind::badData, "it says otherwise about imagery");
  if (!ok) {
    return fail(ErrorKind::badData, fmt::format("{}: tile {} cannot be stored: {}; this is an error in the baker",
                                                impl.path, key.name(), ok.error().message));
  }
  if (ok = impl.write({chunk.meta, blobSum(chunk.mesh), blobSum(chunk.imagery)}); !ok) return ok;
  impl.putData.bindInteger(0, signedCode(key));
  impl.putData.bindBlob(1, chunk.mesh);
  impl.putData.bindBlob(2, chunk.imagery);
  const Result<bool> done = impl.putData.step();
  if (!done) return impl.rollBack(done.error());
  return {};
}

Result<void> DatabaseWriter::setChildren(const TileKey& parent, int childCount) {
  Impl& impl = *impl_;
  if (Result<void> ok = impl.checkTransaction(); !ok) return ok;
  EYE_CHECK(childCount == 0 || childCount == parent.children().count);
  double errorM = 0;  // the greatest of the children's
  if (childCount > 0) {
    for (const TileKey& child : parent.children()) {
      const Result<std::optional<ChunkRecord>> record = impl.find(child);
      if (!record) return tl::unexpected(record.error());
      if (!*record) {
        return fail(ErrorKind::notFound,
                    fmt::format("{}: tile {} is counted by its parent but not in the file", impl.path, child.name()));
      }
      errorM = std::max(errorM, (*record)->meta.geometricErrorM);
    }
  }
  for (std::optional<TileKey> key = parent; key; key = key->parent()) {
    Result<std::optional<ChunkRecord>> record = impl.find(*key);
    if (!record) return tl::unexpected(record.error());
    if (!*record) {
      if (*key != parent) return {};  // a bake may store ancestors later
      return fail(ErrorKind::notFound,
                  fmt::format("{}: tile {} gets children but is not in the file", impl.path, parent.name()));
    }
    ChunkMeta& meta = (*record)->meta;
    if (*key == parent) {
      meta.childCount = static_cast<uint8_t>(childCount);
    } else if (meta.geometricErrorM >= errorM) {
      return {};
    }
    errorM = meta.geometricErrorM = std::max(meta.geometricErrorM, errorM);
    if (Result<void> ok = impl.write(**record); !ok) return ok;
  }
  return {};
}

Result<bool> DatabaseWriter::contains(const TileKey& key) const {
  SqliteStatement& get = impl_->getAll;
  get.bindInteger(0, signedCode(key));
  const SqliteReset reset(get);
  Result<bool> row = get.step();
  if (!row || !*row) return row;
  const Result<ChunkRecord> record = readRecord(get);
  const auto mesh = get.blob(kRecordColumnCount), imagery = get.blob(kRecordColumnCount + 1);
  return record && mesh && imagery && blobSum(*mesh) == record->mesh && blobSum(*imagery) == record->imagery;
}

Result<std::optional<ChunkMeta>> DatabaseWriter::readMeta(const TileKey& key) const {
  const Result<std::optional<ChunkRecord>> record = impl_->find(key);
  if (!record) return tl::unexpected(record.error());
  return *record ? std::optional((*record)->meta) : std::nullopt;
}

Result<void> DatabaseWriter::finish() {
  EYE_CHECK(!impl_->inTransaction || !impl_->database.inTransaction());
  if (Result<void> ok = begin(); !ok) return ok;
  impl_->info.complete = true;
  if (const Result<void> ok = writeInfo(impl_->database, impl_->info); !ok) return impl_->rollBack(ok.error());
  if (Result<void> ok = commit(); !ok) return ok;
  return impl_->database.execute("PRAGMA wal_checkpoint(TRUNCATE)");
}

}  // namespace eye
