// SQLite's C API with lifetimes and with our errors. Used by the database alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/error.h"

struct sqlite3;
struct sqlite3_stmt;

namespace eye {

// A prepared statement. Parameters and columns count from 0 here.
class SqliteStatement {
 public:
  void bindInteger(int parameter, int64_t value);
  void bindReal(int parameter, double value);
  // Not copied: both must outlive the next step().
  void bindText(int parameter, std::string_view value);
  void bindBlob(int parameter, std::span<const std::byte> value);

  // True when there is a row. After the last row, or an error, the statement is reset.
  Result<bool> step();
  void reset();

  // Nothing where the column holds another type than asked for, which only a damaged or hostile file does.
  std::optional<int64_t> integer(int column) const;
  std::optional<double> real(int column) const;
  std::optional<std::string> text(int column) const;
  // Valid until the next step() or reset().
  std::optional<std::span<const std::byte>> blob(int column) const;

 private:
  friend class SqliteConnection;
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
  std::string shownPath_;
  int bindError_ = 0;  // of the first bind that failed; the next step() tells
};

// Resets a statement when a scope is left, so that no lock outlives a read that stopped early.
class SqliteReset {
 public:
  explicit SqliteReset(SqliteStatement& statement) : statement_(statement) {}
  ~SqliteReset() { statement_.reset(); }
  SqliteReset(const SqliteReset&) = delete;
  SqliteReset& operator=(const SqliteReset&) = delete;

 private:
  SqliteStatement& statement_;
};

// One open file. Thread: any one at a time.
class SqliteConnection {
 public:
  // `name` is a path, or a URI where `flags` (SQLITE_OPEN_...) has SQLITE_OPEN_URI; messages begin with `shownPath`.
  static Result<SqliteConnection> open(const std::string& name, int flags, const std::string& shownPath);

  Result<void> execute(const char* sql);
  Result<SqliteStatement> prepare(std::string_view sql);
  // The first column of the first row of a query that always gives one.
  Result<int64_t> queryInteger(const char* sql);
  bool inTransaction() const;
  sqlite3* raw() const { return database_.get(); }

 private:
  struct Close {
    void operator()(sqlite3* database) const;
  };
  std::unique_ptr<sqlite3, Close> database_;
  std::string shownPath_;
};

// A path as SQLite's URI with the given query, such as "immutable=1".
std::string sqliteUri(const std::string& path, const std::string& query);

// What an SQLite result code means to a user of the file at `shownPath`.
Error sqliteError(int code, const std::string& shownPath, const std::string& detail);

}  // namespace eye
