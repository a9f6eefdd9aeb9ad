// The configuration file: TOML with a key for each long option.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/error.h"

namespace eye {

// Values as the command line would have them: `size = "800x600"`, `sse = 1.5`, `headless = true`, `host = ["a", "b"]`.
using ConfigValues = std::map<std::string, std::vector<std::string>>;
Result<ConfigValues> readConfigFile(const std::string& path);

// The known word nearest to `word` by edit distance, for "did you mean"; empty where none is near.
std::string nearestWord(const std::string& word, const std::vector<std::string>& known);

}  // namespace eye
