#include "terrain/sqlite_handle.h"

#include <fmt/format.h>
#include <sqlite3.h>

namespace eye {
namespace {

// A bake commits in milliseconds; whoever waits longer than this waits for something else.
constexpr int kBusyTimeoutMs = 5000;

}  // namespace

Error sqliteError(int code, const std::string& shownPath, const std::string& detail) {
  const auto error = [&](ErrorKind kind, const std::string& what) { return Error{kind, shownPath + ": " + what}; };
  switch (code & 0xFF) {  // the primary code; extended ones refine it
    case SQLITE_FULL:
      return error(ErrorKind::noSpace, "the disk is full; make room and go on with --resume");
    case SQLITE_IOERR:
      return error(ErrorKind::io, "reading or writing failed (" + detail + "); check the disk");
    case SQLITE_CANTOPEN:
      return error(ErrorKind::io, "cannot be opened (" + detail + "); check the folder and the rights to it");
    case SQLITE_READONLY:
    case SQLITE_PERM:
      return error(ErrorKind::io, "cannot be written (" + detail + "); check the rights to the file and its folder");
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return error(ErrorKind::io, "is in use by another program; wait for it or stop it");
    case SQLITE_NOTADB:
      return error(ErrorKind::badData, "is not a terrain database; make one with eyepoint-bake");
    case SQLITE_CORRUPT:
    case SQLITE_TOOBIG:
      return error(ErrorKind::badData, "the file is damaged (" + detail + "); restore it or bake it again");
    default:
      return error(ErrorKind::badData, "cannot be used (" + detail + "); restore it or bake it again");
  }
}

std::string sqliteUri(const std::string& path, const std::string& query) {
  std::string uri = "file:";
  for (const char c : path) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '/' ||
                       c == '.' || c == '_' || c == '-';
    uri += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return uri + "?" + query;
}

void SqliteStatement::Finalize::operator()(sqlite3_stmt* statement) const {
  sqlite3_finalize(statement);
}

void SqliteStatement::bindInteger(int parameter, int64_t value) {
  const int code = sqlite3_bind_int64(statement_.get(), parameter + 1, value);
  if (bindError_ == SQLITE_OK) bindError_ = code;
}

void SqliteStatement::bindReal(int parameter, double value) {
  const int code = sqlite3_bind_double(statement_.get(), parameter + 1, value);
  if (bindError_ == SQLITE_OK) bindError_ = code;
}

void SqliteStatement::bindText(int parameter, std::string_view value) {
  const int code =
      sqlite3_bind_text64(statement_.get(), parameter + 1, value.data(), value.size(), SQLITE_STATIC, SQLITE_UTF8);
  if (bindError_ == SQLITE_OK) bindError_ = code;
}

void SqliteStatement::bindBlob(int parameter, std::span<const std::byte> value) {
  // A null pointer would bind NULL; an empty blob is a blob.
  const void* const bytes = value.empty() ? static_cast<const void*>("") : value.data();
  const int code = sqlite3_bind_blob64(statement_.get(), parameter + 1, bytes, value.size(), SQLITE_STATIC);
  if (bindError_ == SQLITE_OK) bindError_ = code;
}

Result<bool> SqliteStatement::step() {
  int code = bindError_;
  bindError_ = SQLITE_OK;
  if (code == SQLITE_OK) code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  std::string detail;
  if (code != SQLITE_DONE) detail = sqlite3_errmsg(sqlite3_db_handle(statement_.get()));
  sqlite3_reset(statement_.get());
  if (code == SQLITE_DONE) return false;
  return tl::unexpected(sqliteError(code, shownPath_, detail));
}

void SqliteStatement::reset() {
  sqlite3_reset(statement_.get());
}

std::optional<int64_t> SqliteStatement::integer(int column) const {
  if (sqlite3_column_type(statement_.get(), column) != SQLITE_INTEGER) return std::nullopt;
  return sqlite3_column_int64(statement_.get(), column);
}

std::optional<double> SqliteStatement::real(int column) const {
  if (sqlite3_column_type(statement_.get(), column) != SQLITE_FLOAT) return std::nullopt;
  return sqlite3_column_double(statement_.get(), column);
}

std::optional<std::string> SqliteStatement::text(int column) const {
  if (sqlite3_column_type(statement_.get(), column) != SQLITE_TEXT) return std::nullopt;
  const unsigned char* const bytes = sqlite3_column_text(statement_.get(), column);
  if (bytes == nullptr) return std::nullopt;  // out of memory
  const int size = sqlite3_column_bytes(statement_.get(), column);
  return std::string(reinterpret_cast<const char*>(bytes), static_cast<size_t>(size));
}

std::optional<std::span<const std::byte>> SqliteStatement::blob(int column) const {
  if (sqlite3_column_type(statement_.get(), column) != SQLITE_BLOB) return std::nullopt;
  const void* const bytes = sqlite3_column_blob(statement_.get(), column);
  const int size = sqlite3_column_bytes(statement_.get(), column);
  if (bytes == nullptr && size != 0) return std::nullopt;  // out of memory
  return std::span(static_cast<const std::byte*>(bytes), static_cast<size_t>(size));
}

void SqliteConnection::Close::operator()(sqlite3* database) const {
  sqlite3_close_v2(database);
}

Result<SqliteConnection> SqliteConnection::open(const std::string& name, int flags, const std::string& shownPath) {
  SqliteConnection connection;
  connection.shownPath_ = shownPath;
  sqlite3* database = nullptr;
  const int code = sqlite3_open_v2(name.c_str(), &database, flags, nullptr);
  connection.database_.reset(database);  // SQLite gives a handle to close even where opening failed
  if (code != SQLITE_OK) {
    return tl::unexpected(sqliteError(code, shownPath, database != nullptr ? sqlite3_errmsg(database) : "no memory"));
  }
  sqlite3_busy_timeout(database, kBusyTimeoutMs);
  return connection;
}

Result<void> SqliteConnection::execute(const char* sql) {
  const int code = sqlite3_exec(database_.get(), sql, nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) return tl::unexpected(sqliteError(code, shownPath_, sqlite3_errmsg(database_.get())));
  return {};
}

Result<SqliteStatement> SqliteConnection::prepare(std::string_view sql) {
  SqliteStatement statement;
  statement.shownPath_ = shownPath_;
  sqlite3_stmt* raw = nullptr;
  const int code = sqlite3_prepare_v3(database_.get(), sql.data(), static_cast<int>(sql.size()),
                                      SQLITE_PREPARE_PERSISTENT, &raw, nullptr);
  statement.statement_.reset(raw);
  if (code != SQLITE_OK) return tl::unexpected(sqliteError(code, shownPath_, sqlite3_errmsg(database_.get())));
  return statement;
}

Result<int64_t> SqliteConnection::queryInteger(const char* sql) {
  Result<SqliteStatement> statement = prepare(sql);
  if (!statement) return tl::unexpected(statement.error());
  const Result<bool> row = statement->step();
  if (!row) return tl::unexpected(row.error());
  const std::optional<int64_t> value = *row ? statement->integer(0) : std::nullopt;
  if (!value) return fail(ErrorKind::badData, shownPath_ + ": the file is damaged; restore it or bake it again");
  return *value;
}

bool SqliteConnection::inTransaction() const {
  return sqlite3_get_autocommit(database_.get()) == 0;
}

}  // namespace eye
