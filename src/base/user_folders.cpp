#include "base/user_folders.h"

#include <cstdlib>

namespace eye {
namespace {

std::optional<std::filesystem::path> folderBy(const char* variable, const char* belowHome) {
  const auto value = [](const char* name) -> std::optional<std::filesystem::path> {
    const char* text = std::getenv(name);
    if (text == nullptr || *text == '\0') return std::nullopt;
    return text;
  };
  if (const auto folder = value(variable)) return *folder / "eyepoint";
  if (const auto home = value("HOME")) return *home / belowHome / "eyepoint";
  return std::nullopt;
}

}  // namespace

std::optional<std::filesystem::path> userCacheFolder() {
  return folderBy("XDG_CACHE_HOME", ".cache");
}

std::string defaultTerrainPath() {
  return folderBy("XDG_DATA_HOME", ".local/share").value_or("./.local/share/eyepoint") / "demo.eyt";
}

}  // namespace eye
