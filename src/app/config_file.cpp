#include "app/config_file.h"

#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <toml++/toml.h>

namespace eye {
namespace {

// A scalar in the words of the command line; nothing for times and tables.
std::optional<ConfigWord> wordOf(const toml::node& node) {
  if (const auto* text = node.as_string()) return ConfigWord{text->get(), ConfigType::text};
  if (const auto* number = node.as_integer()) return ConfigWord{std::to_string(number->get()), ConfigType::number};
  if (const auto* number = node.as_floating_point())
    return ConfigWord{fmt::format("{}", number->get()), ConfigType::number};
  if (const auto* flag = node.as_boolean()) return ConfigWord{flag->get() ? "true" : "false", ConfigType::flag};
  if (const auto* date = node.as_date())
    return ConfigWord{fmt::format("{:04}-{:02}-{:02}", date->get().year, date->get().month, date->get().day),
                      ConfigType::text};
  return std::nullopt;
}

}  // namespace

Result<ConfigValues> parseConfig(std::string_view text, const std::string& path) {
  toml::table table;
  try {
    table = toml::parse(text, path);
  } catch (const toml::parse_error& error) {
    return fail(ErrorKind::usage, fmt::format("{}:{}:{}: {}; mend the file's TOML", path, error.source().begin.line,
                                              error.source().begin.column, error.description()));
  }
  ConfigValues values;
  for (const auto& [key, node] : table) {
    const std::string name(key.str());
    std::vector<ConfigWord>& words = values[name];
    const auto take = [&](const toml::node& item) {
      const std::optional<ConfigWord> word = wordOf(item);
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

Result<ConfigValues> readConfigFile(const std::string& path) {
  std::error_code failed;
  if (!std::filesystem::is_regular_file(path, failed))
    return fail(ErrorKind::usage, fmt::format("{}: no such configuration file; check --config", path));
  std::ifstream file(path, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  if (!file) return fail(ErrorKind::usage, fmt::format("{}: cannot be read; check --config and its rights", path));
  return parseConfig(text, path);
}

}  // namespace eye
