// The database's tables and its `info`: made, checked, read.
#pragma once

#include <string>

#include "base/error.h"
#include "terrain/database.h"
#include "terrain/sqlite_handle.h"

namespace eye {

// Limits, and what SQLite offers against files that were made to harm. Before anything else on a connection.
Result<void> harden(SqliteConnection& database);

// In an empty file: page size, marks, tables and `info`, which must be good (checkInfo).
Result<void> createSchema(SqliteConnection& database, const DatabaseInfo& info);
// That the file is a terrain database of this version with exactly our tables: no views, triggers or indices.
Result<void> checkSchema(SqliteConnection& database, const std::string& path);

Result<void> writeInfo(SqliteConnection& database, const DatabaseInfo& info);
Result<DatabaseInfo> readInfo(SqliteConnection& database, const std::string& path);
// Ranges of every field; the error is without the file's name.
Result<void> checkInfo(const DatabaseInfo& info);

// Missing, a folder, empty: what can be said before SQLite looks at it.
Result<void> checkFile(const std::string& path);

}  // namespace eye
