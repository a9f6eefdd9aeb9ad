#include "app/config_file.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>
#include <toml++/toml.h>

namespace eye {
namespace {

// A scalar in the words of the command line; nothing for dates and tables.
std::optional<std::string> wordOf(const toml::node& node) {
  if (const auto* text = node.as_string()) return text->get();
  if (const auto* number = node.as_integer()) return std::to_string(number->get());
  if (const auto* number = node.as_floating_point()) return fmt::format("{}", number->get());
  if (const auto* flag = node.as_boolean()) return flag->get() ? "true" : "false";
  return std::nullopt;
}

size_t editDistance(const std::string& a, const std::string& b) {
  std::vector<size_t> row(b.size() + 1);
  for (size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (size_t i = 1; i <= a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t substituted = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({substituted, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

}  // namespace

Result<ConfigValues> readConfigFile(const std::string& path) {
  std::error_code failed;
  if (!std::filesystem::is_regular_file(path, failed))
    return fail(ErrorKind::usage, fmt::format("{}: no such configuration file; check --config", path));
  toml::table table;
  try {
    table = toml::parse_file(path);
  } catch (const toml::parse_error& error) {
    return fail(ErrorKind::usage, fmt::format("{}:{}:{}: {}; mend the file's TOML", path, error.source().begin.line,
                                              error.source().begin.column, error.description()));
  }
  ConfigValues values;
  for (const auto& [key, node] : table) {
    const std::string name(key.str());
    std::vector<std::string>& words = values[name];
    const auto take = [&](const toml::node& item) {
      const std::optional<std::string> word = wordOf(item);
      if (word) words.push_back(*word);
      return word.has_value();
    };
    bool understood = true;
    if (const toml::array* array = node.as_array()) {
      for (const toml::node& item : *array) understood = understood && take(item);
    } else {
      understood = take(node);
    }
    if (!understood)
      return fail(ErrorKind::usage, fmt::format("{}:{}: {} must be a text, a number, true/false or a list of these",
                                                path, node.source().begin.line, name));
  }
  return values;
}

std::string nearestWord(const std::string& word, const std::vector<std::string>& known) {
  std::string nearest;
  size_t least = std::max<size_t>(3, word.size() / 2 + 1);  // farther than this is no slip of the keyboard
  for (const std::string& candidate : known) {
    const size_t distance = editDistance(word, candidate);
    if (distance < least) {
      least = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

}  // namespace eye
