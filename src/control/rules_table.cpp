#include "control/rules_table.h"

#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/nearest_word.h"

namespace eye {
namespace {

constexpr size_t kMostPoints = 64;  // of a membership function

// Integers and floats alike; nothing for other types, NaN and infinities.
std::optional<double> finiteNumber(const toml::node& node) {
  if (!node.is_number()) return std::nullopt;
  const std::optional<double> value = node.value<double>();
  return value && std::isfinite(*value) ? value : std::nullopt;
}

bool within(double value, Limits limits) {
  return value >= limits.least && value <= limits.most;
}

}  // namespace

const toml::node* RulesTable::find(const std::string& key) {
  known_.push_back(key);
  return table_ && !error_ ? table_->get(key) : nullptr;
}

void RulesTable::fail(const toml::node* node, const std::string& key, const std::string& what) {
  if (error_) return;
  const auto line = node ? node->source().begin.line : table_->source().begin.line;
  error_ =
      Error{ErrorKind::usage, fmt::format("{}:{}: {}{} {}", path_, line, name_.empty() ? "" : name_ + ".", key, what)};
}

void RulesTable::number(const std::string& key, Limits limits, double& value) {
  const toml::node* node = find(key);
  if (!node) return;
  const std::optional<double> number = finiteNumber(*node);
  if (number && within(*number, limits)) {
    value = *number;
  } else {
    fail(node, key, fmt::format("must be a number from {} to {}", limits.least, limits.most));
  }
}

void RulesTable::count(const std::string& key, Limits limits, int& value) {
  const toml::node* node = find(key);
  if (!node) return;
  const toml::value<int64_t>* number = node->as_integer();
  if (number && within(static_cast<double>(number->get()), limits)) {
    value = static_cast<int>(number->get());
  } else {
    fail(node, key, fmt::format("must be a whole number from {} to {}", limits.least, limits.most));
  }
}

void RulesTable::word(const std::string& key, const std::vector<std::string>& words, size_t& place) {
  const toml::node* node = find(key);
  if (!node) return;
  const toml::value<std::string>* text = node->as_string();
  const auto found = text ? std::find(words.begin(), words.end(), text->get()) : words.end();
  if (found != words.end()) {
    place = static_cast<size_t>(found - words.begin());
  } else {
    fail(node, key, fmt::format("must be \"{}\"", fmt::join(words, "\" or \"")));
  }
}

std::optional<std::vector<double>> RulesTable::list(const std::string& key, Limits limits, bool increasing) {
  const toml::node* node = find(key);
  if (!node) return std::nullopt;
  std::vector<double> values;
  bool right = node->as_array() && !node->as_array()->empty() && node->as_array()->size() <= kMostPoints;
  for (size_t i = 0; right && i < node->as_array()->size(); ++i) {
    const std::optional<double> number = finiteNumber(*node->as_array()->get(i));
    right = number && within(*number, limits) && (!increasing || values.empty() || *number > values.back());
    if (right) values.push_back(*number);
  }
  if (right) return values;
  fail(node, key,
       fmt::format("must be a list of up to {} numbers from {} to {}{}", kMostPoints, limits.least, limits.most,
                   increasing ? ", each above the one before" : ""));
  return std::nullopt;
}

void RulesTable::numbers(const std::string& key, Limits limits, bool increasing, std::span<double> values) {
  const std::optional<std::vector<double>> given = list(key, limits, increasing);
  if (!given) return;
  if (given->size() == values.size()) {
    std::copy(given->begin(), given->end(), values.begin());
  } else {
    fail(table_->get(key), key, fmt::format("has {} numbers, but needs {}", given->size(), values.size()));
  }
}

void RulesTable::membership(const std::string& pointsKey, Limits points, const std::string& valuesKey,
                            Membership& membership) {
  const std::optional<std::vector<double>> at = list(pointsKey, points, true);
  const std::optional<std::vector<double>> value = list(valuesKey, {0, 1}, false);
  if (at) membership.at = *at;
  if (value) membership.value = *value;
  if ((at || value) && membership.at.size() != membership.value.size())
    fail(table_->get(at ? pointsKey : valuesKey), at ? pointsKey : valuesKey,
         fmt::format("and {} must be of one length, but have {} and {} numbers", at ? valuesKey : pointsKey,
                     (at ? membership.at : membership.value).size(), (at ? membership.value : membership.at).size()));
}

const toml::table* RulesTable::section(const std::string& key) {
  const toml::node* node = find(key);
  if (!node) return nullptr;
  if (!node->as_table()) fail(node, key, fmt::format("must be a section: [{}]", key));
  return node->as_table();
}

std::optional<Error> RulesTable::finish() {
  if (!table_) return error_;
  for (const auto& [key, node] : *table_) {
    const std::string name(key.str());
    if (std::find(known_.begin(), known_.end(), name) != known_.end()) continue;
    const std::string nearest = nearestWord(name, known_);
    fail(&node, name,
         nearest.empty() ? fmt::format("is not known; known are: {}", fmt::join(known_, ", "))
                         : fmt::format("is not known; did you mean {}?", nearest));
  }
  return error_;
}

}  // namespace eye
