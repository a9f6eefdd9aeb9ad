#include "control/selector_rules.h"

#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "control/rules_table.h"

namespace eye {
namespace {

constexpr Limits kShare{0, 1};
constexpr Limits kPitchDeg{-90, 90};
constexpr Limits kSum{0, 20};  // weights up to 10 each

std::optional<Error> readPaper(const std::string& path, const toml::table* section, PaperRules& rules) {
  RulesTable table(path, "paper", section);
  size_t reference = static_cast<size_t>(rules.altitudeReference);
  table.word("altitude-reference", {"ground", "sea"}, reference);
  rules.altitudeReference = static_cast<AltitudeReference>(reference);
  table.membership("altitude-ft", {-2000, 1e6}, "altitude-membership", rules.altitudeFt);
  table.membership("pitch-deg", kPitchDeg, "pitch-membership", rules.pitchDeg);
  table.numbers("bands", {0.05, 2}, true, rules.bands);
  // Well below the first edge, or the sum could never fall out of its band.
  table.number("hysteresis", {0.02, rules.bands[0] / 2}, rules.hysteresis);
  return table.finish();
}

std::optional<Error> readAdaptive(const std::string& path, const toml::table* section, AdaptiveRules& rules) {
  RulesTable table(path, "adaptive", section);
  table.membership("height-over-relief", {0, 1000}, "height-membership", rules.heightOverRelief);
  table.membership("pitch-deg", kPitchDeg, "pitch-membership", rules.pitchDeg);
  table.number("altitude-weight", {0, 10}, rules.altitudeWeight);
  table.number("pitch-weight", {0, 10}, rules.pitchWeight);
  table.membership("sum", kSum, "share", rules.shareOfSum);
  table.number("measurement-reach", {0.01, 20}, rules.measurementReach);

  table.number("triangle-cost-ns", {0.001, 10000}, rules.triangleCostNs);
  table.number("triangle-cost-max-ns", {0.001, 10000}, rules.triangleCostMaxNs);
  table.number("triangle-cost-trust", {1, 1e9}, rules.triangleCostTrust);
  table.numbers("pass-cost-ms", {0.0001, 1000}, false, rules.passCostMs);
  table.numbers("share-of-largest", {0.01, 1}, false, rules.shareOfLargest);

  table.number("hysteresis", kShare, rules.hysteresis);
  table.count("dwell-frames", {1, 100000}, rules.dwellFrames);
  table.count("settle-frames", {0, 60}, rules.settleFrames);
  table.count("trial-frames", {1, 60}, rules.trialFrames);
  table.count("first-interval-frames", {2, 100000}, rules.firstIntervalFrames);
  table.count("longest-interval-frames", {2, 100000}, rules.longestIntervalFrames);
  table.number("loss-rate", {0, 0.1}, rules.lossRate);
  table.number("loss-reserve", {0, 100}, rules.lossReserve);
  if (std::optional<Error> error = table.finish()) return error;
  if (rules.longestIntervalFrames < rules.firstIntervalFrames)
    return Error{ErrorKind::usage, fmt::format("{}: adaptive.longest-interval-frames is {}, below "
                                               "first-interval-frames {}; give at least as much",
                                               path, rules.longestIntervalFrames, rules.firstIntervalFrames)};
  return std::nullopt;
}

}  // namespace

Result<SelectorRules> parseSelectorRules(std::string_view text, const std::string& path) {
  toml::table file;
  try {
    file = toml::parse(text, path);
  } catch (const toml::parse_error& error) {
    return fail(ErrorKind::usage, fmt::format("{}:{}:{}: {}; mend the file's TOML", path, error.source().begin.line,
                                              error.source().begin.column, error.description()));
  }
  SelectorRules rules;
  RulesTable table(path, "", &file);
  size_t mode = static_cast<size_t>(rules.mode);
  table.word("mode", {"paper", "adaptive"}, mode);
  rules.mode = static_cast<SelectorMode>(mode);
  const toml::table* paper = table.section("paper");
  const toml::table* adaptive = table.section("adaptive");
  std::optional<Error> error = table.finish();
  if (!error) error = readPaper(path, paper, rules.paper);
  if (!error) error = readAdaptive(path, adaptive, rules.adaptive);
  if (error) return tl::unexpected<Error>(*error);
  return rules;
}

Result<SelectorRules> loadSelectorRules(const std::string& path) {
  std::error_code failed;
  if (!std::filesystem::is_regular_file(path, failed))
    return fail(ErrorKind::usage, fmt::format("{}: no such file of selector rules; check its path", path));
  std::ifstream file(path, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  if (!file) return fail(ErrorKind::usage, fmt::format("{}: cannot be read; check its rights", path));
  return parseSelectorRules(text, path);
}

}  // namespace eye
