#include "bench/read_json.h"

#include <filesystem>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

namespace eye {

Result<nlohmann::ordered_json> readJson(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored))
    return fail(ErrorKind::notFound, fmt::format("{0}: is a folder; give the file, such as {0}/report.json", path));
  std::ifstream file(path, std::ios::binary);
  if (!file)
    return fail(
        ErrorKind::notFound,
        fmt::format("{}: cannot be read: no such file, or no right to it; eyepoint-bench SUITE --out DIR writes "
                    "DIR/report.json",
                    path));
  std::stringstream text;
  text << file.rdbuf();
  nlohmann::ordered_json json = nlohmann::ordered_json::parse(text.str(), nullptr, false);
  if (json.is_discarded())
    return fail(ErrorKind::badData, fmt::format("{}: is no JSON, or ends too early; write it anew", path));
  return json;
}

}  // namespace eye
