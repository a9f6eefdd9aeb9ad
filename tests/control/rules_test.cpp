#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>

#include <unistd.h>

#include "control/selector_rules.h"
#include "support/places.h"

using namespace eye;

namespace {

struct RulesFile {
  std::string path =
      (std::filesystem::temp_directory_path() / ("eyepoint_rules_" + std::to_string(getpid()) + ".toml")).string();
  explicit RulesFile(const std::string& text) { std::ofstream(path) << text; }
  ~RulesFile() { std::filesystem::remove(path); }
};

std::string errorOf(const std::string& text) {
  const RulesFile file(text);
  const Result<SelectorRules> rules = loadSelectorRules(file.path);
  if (rules) return "";
  CHECK(rules.error().kind == ErrorKind::usage);
  CHECK(rules.error().message.find('\n') == std::string::npos);
  CHECK(rules.error().message.find(file.path) == 0);
  return rules.error().message;
}

}  // namespace

TEST_CASE("the installed rules file is the built-in defaults, key for key") {
  const std::string path = eye::test::kSourceDir + "/config/selector.toml";
  const Result<SelectorRules> rules = loadSelectorRules(path);
  REQUIRE(rules);
  CHECK(*rules == SelectorRules{});

  // Each of its keys is read and explained.
  std::ifstream in(path);
  std::string section;
  int keys = 0;
  for (std::string line; std::getline(in, line);) {
    if (!line.empty() && line[0] == '[') section = line + "\n";
    const size_t equals = line.find('=');
    if (line.empty() || line.find_first_of("#[ ") == 0 || equals == std::string::npos) continue;
    ++keys;
    INFO(line);
    CHECK(line.find('#', equals) != std::string::npos);
    const std::string key = line.substr(0, line.find_first_of(" ="));
    CHECK_THAT(errorOf(section + key + " = \"no such value\""), Catch::Contains(key + " must be"));
  }
  CHECK(keys == 30);
}

TEST_CASE("keys that are given change the rules, others keep their defaults") {
  const RulesFile file(R"(mode = "paper"
[paper]
altitude-reference = "sea"
altitude-ft = [100, 200]
altitude-membership = [1, 0]
bands = [0.2, 0.4, 0.6, 0.8]
[adaptive]
triangle-cost-ns = 90
trial-frames = 5
pass-cost-ms = [1, 2, 3, 4]
)");
  const Result<SelectorRules> rules = loadSelectorRules(file.path);
  REQUIRE(rules);
  SelectorRules expected;
  expected.mode = SelectorMode::paper;
  expected.paper.altitudeReference = AltitudeReference::sea;
  expected.paper.altitudeFt = {{100, 200}, {1, 0}};
  expected.paper.bands = {0.2, 0.4, 0.6, 0.8};
  expected.adaptive.triangleCostNs = 90;
  expected.adaptive.trialFrames = 5;
  expected.adaptive.passCostMs = {1, 2, 3, 4};
  CHECK(*rules == expected);
}

TEST_CASE("a wrong rules file is one line that says where and what would be right") {
  const std::vector<std::pair<std::string, std::string>> wrong{
      {"mode = \"papr\"", "mode must be \"paper\" or \"adaptive\""},
      {"mode = 3", ":1: mode must be"},
      {"mod = \"paper\"", "mod is not known; did you mean mode?"},
      {"[papers]", "did you mean paper?"},
      {"paper = 3", "must be a section: [paper]"},
      {"[paper]\nhysteresi = 0.1", ":2: paper.hysteresi is not known; did you mean hysteresis?"},
      {"[paper]\nzzz = 0.1", "known are: altitude-reference"},
      {"[paper]\nhysteresis = 0.01", "must be a number from 0.02 to 0.05"},
      {"[paper]\nhysteresis = nan", "must be a number"},
      {"[paper]\nhysteresis = \"0.1\"", "must be a number"},
      {"[paper]\nbands = [0.1, 0.5, 0.5, 1.5]", "each above the one before"},
      {"[paper]\nbands = [0.1, 0.5, 1.5]", "has 3 numbers, but needs 4"},
      {"[paper]\nbands = [0.1, 0.5, 1.0, 2.5]", "from 0.05 to 2"},
      {"[paper]\naltitude-ft = [1, 2, 3, 4, 4]", "each above the one before"},
      {"[paper]\naltitude-ft = [1, 2]", "must be of one length, but have 2 and 5"},
      {"[paper]\npitch-membership = [1, 0.5, 0]", "must be of one length, but have 3 and 2"},
      {"[paper]\npitch-membership = [1, -0.1]", "from 0 to 1"},
      {"[paper]\npitch-deg = []", "must be a list"},
      {"[paper]\npitch-deg = [nan, 3]", "must be a list"},
      {"[paper]\npitch-deg = 3", "must be a list"},
      {"[adaptive]\naltitude-weight = inf", "must be a number from 0 to 10"},
      {"[adaptive]\npitch-weight = -1", "must be a number from 0 to 10"},
      {"[adaptive]\npass-cost-ms = [0, 1, 1, 1]", "from 0.0001 to 1000"},
      {"[adaptive]\ntrial-frames = 2.5", "must be a whole number from 1 to 60"},
      {"[adaptive]\ntrial-frames = 99999999999999", "must be a whole number"},
      {"[adaptive]\nfirst-interval-frames = 2000", "below first-interval-frames 2000"},
      {"[adaptive\n", "mend the file's TOML"},
  };
  for (const auto& [text, words] : wrong) {
    INFO(text);
    CHECK_THAT(errorOf(text), Catch::Contains(words));
  }
  const Result<SelectorRules> missing = loadSelectorRules("/nowhere/rules.toml");
  REQUIRE_FALSE(missing);
  CHECK_THAT(missing.error().message, Catch::Contains("/nowhere/rules.toml: no such file"));
}

TEST_CASE("points of a membership function") {
  const Membership membership{{1, 2, 4}, {0, 1, 0.5}};
  CHECK(membershipAt(membership, -5) == 0);
  CHECK(membershipAt(membership, 1.25) == Approx(0.25));
  CHECK(membershipAt(membership, 2) == 1);
  CHECK(membershipAt(membership, 3) == Approx(0.75));
  CHECK(membershipAt(membership, 4) == 0.5);
  CHECK(membershipAt(membership, 1e300) == 0.5);
  CHECK(membershipAt(Membership{{3}, {0.7}}, -1) == 0.7);
}
