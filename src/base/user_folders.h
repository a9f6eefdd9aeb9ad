// Where the files of this user lie, by the XDG Base Directory Specification. An empty variable counts as none.
#pragma once

#include <filesystem>
#include <optional>

namespace eye {

// Nothing without a home: $XDG_CACHE_HOME/eyepoint, else ~/.cache/eyepoint.
std::optional<std::filesystem::path> userCacheFolder();
// The embedded terrain's: $XDG_DATA_HOME/eyepoint/demo.eyt, else ~/.local/share/eyepoint/demo.eyt.
std::string defaultTerrainPath();

}  // namespace eye
