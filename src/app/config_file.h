// The configuration file: TOML with a key for each long option.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace eye {

// Values in the words of the command line: `size = "800x600"`, `sse = 1.5`, `headless = true`, `host = ["a", "b"]`.
enum class ConfigType { text, number, flag };
struct ConfigWord {
  std::string text;
  ConfigType type = ConfigType::text;
};
using ConfigValues = std::map<std::string, std::vector<ConfigWord>>;
// `path`: for complaints.
Result<ConfigValues> parseConfig(std::string_view text, const std::string& path);
Result<ConfigValues> readConfigFile(const std::string& path);

}  // namespace eye
