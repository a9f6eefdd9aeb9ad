// The operating system's copy of a file in memory, for measurements that begin cold.
#pragma once

#include <optional>
#include <string>

namespace eye {

// Asks for the file's pages to be dropped. Returns the share of the file that is in memory afterwards, 0 to 1; nothing
// where the system does not say.
std::optional<double> dropFromPageCache(const std::string& path);

}  // namespace eye
