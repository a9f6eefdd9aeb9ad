// Reading a TOML table of numbers and words strictly: the first thing that is wrong stays as the error.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <toml++/toml.h>

#include "base/error.h"
#include "control/membership.h"

namespace eye {

struct Limits {
  double least, most;
};

// Every reader below leaves the default alone where its key is not given. Ask finish() at last: it finds keys that no
// reader asked for.
class RulesTable {
 public:
  // `table` null: a section that is not there. `name` stands in messages: "" or "adaptive".
  RulesTable(std::string path, std::string name, const toml::table* table)
      : path_(std::move(path)), name_(std::move(name)), table_(table) {}

  void number(const std::string& key, Limits limits, double& value);
  void count(const std::string& key, Limits limits, int& value);
  // One of the words; gives its place.
  void word(const std::string& key, const std::vector<std::string>& words, size_t& place);
  // As many numbers as `values` has.
  void numbers(const std::string& key, Limits limits, bool increasing, std::span<double> values);
  // Two keys: points that increase, and the values there.
  void membership(const std::string& pointsKey, Limits points, const std::string& valuesKey, Membership& membership);
  // A section, read by a table of its own.
  const toml::table* section(const std::string& key);

  std::optional<Error> finish();

 private:
  const toml::node* find(const std::string& key);
  void fail(const toml::node* node, const std::string& key, const std::string& what);
  std::optional<std::vector<double>> list(const std::string& key, Limits limits, bool increasing);

  std::string path_, name_;
  const toml::table* table_;
  std::vector<std::string> known_;
  std::optional<Error> error_;
};

}  // namespace eye
