// JSON files that programs wrote and people may have changed.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "base/error.h"

namespace eye {

// notFound or badData with the file's name and what to do.
Result<nlohmann::ordered_json> readJson(const std::string& path);

}  // namespace eye
