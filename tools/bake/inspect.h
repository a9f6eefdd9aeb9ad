// What `info` and `verify` say about a database.
#pragma once

#include <string>

#include "base/error.h"

namespace eye {

// On stdout, as a table or as one JSON object.
Result<void> printInfo(const std::string& path, bool json);
// Every checksum and invariant; the first damage is the error.
Result<void> verify(const std::string& path);

}  // namespace eye
