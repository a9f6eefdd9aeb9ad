#include "app/options.h"

#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "app/config_file.h"
#include "app/option_groups.h"
#include "app/option_values.h"
#include "base/nearest_word.h"
#include "base/version.h"

namespace eye {
namespace {

bool takesNumber(CLI::Option& option) {
  try {
    return option.get_validator(kNumber) != nullptr;
  } catch (const CLI::OptionNotFound&) {
    return false;
  }
}

// Numbers and flags have types of their own in TOML; everything else is text. `rate`, `host-delay` and `vsync` are
// words that may be a number or a flag.
Result<void> checkType(CLI::Option& option, const std::string& key, const ConfigWord& word) {
  const bool isFlag = option.get_items_expected_max() == 0, isNumber = takesNumber(option);
  if (word.type == (isFlag ? ConfigType::flag : isNumber ? ConfigType::number : ConfigType::text)) return {};
  if ((key == "rate" || key == "host-delay") && word.type == ConfigType::number) return {};
  if (key == "vsync" && word.type == ConfigType::flag) return {};
  const std::string given = word.type == ConfigType::text ? '"' + word.text + '"' : word.text;
  const std::string wanted =
      isFlag ? "true or false" : (isNumber ? "a number, " : "text in quotes, ") + option.get_type_name();
  return fail(ErrorKind::usage, fmt::format("{} takes {}; got {}", key, wanted, given));
}

// What the file says, for each option that the command line left out.
Result<void> applyConfig(CLI::App& app, const std::string& path) {
  const Result<ConfigValues> values = readConfigFile(path);
  if (!values) return tl::unexpected(values.error());
  std::vector<std::string> known;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames())
      if (name != "help" && name != "version" && name != "config") known.push_back(name);
  // Two options that say the same thing win over both of the file's keys.
  const auto given = [&](const char* name) { return app.get_option(name)->count() > 0; };
  const bool stateGiven = given("--pose") || given("--host"), frustumGiven = given("--fov") || given("--frustum");
  const bool hoursGiven = given("--time-of-day") || given("--utc");
  for (const auto& [key, words] : *values) {
    if ((stateGiven && (key == "pose" || key == "host")) || (frustumGiven && (key == "fov" || key == "frustum")) ||
        (hoursGiven && (key == "time-of-day" || key == "utc")))
      continue;
    if (std::find(known.begin(), known.end(), key) == known.end()) {
      const std::string nearest = nearestWord(key, known);
      return fail(ErrorKind::usage, fmt::format("{}: unknown key '{}'; {}", path, key,
                                                nearest.empty() ? "see eyepoint --help for the keys"
                                                                : fmt::format("did you mean '{}'?", nearest)));
    }
    CLI::Option* option = app.get_option("--" + key);
    if (option->count() > 0) continue;
    try {
      if (words.size() > 1 && option->get_expected_max() <= 1 && key != "host")
        return fail(ErrorKind::usage, fmt::format("{}: {} takes one value", path, key));
      for (const ConfigWord& word : words) {
        if (const Result<void> ok = checkType(*option, key, word); !ok)
          return fail(ErrorKind::usage, fmt::format("{}: {}", path, ok.error().message));
        option->add_result(word.text);
      }
      option->run_callback();
    } catch (const CLI::Error& error) {
      return fail(ErrorKind::usage, fmt::format("{}: {}: {}", path, key, error.what()));
    }
  }
  return {};
}

std::string oneLine(std::string text) {
  for (char& c : text)
    if (c == '\n') c = ' ';
  return text;
}

}  // namespace

std::string Options::settingsLine() const {
  const std::string map = depthMap == DepthMapMode::off     ? "off"
                          : depthMap == DepthMapMode::fixed ? fmt::format("{}x{}", depthMapPx.x, depthMapPx.y)
                                                            : "auto";
  const std::string offset = viewOffsetDeg ? fmt::format(" view-offset={},{},{}", (*viewOffsetDeg)[0],
                                                         (*viewOffsetDeg)[1], (*viewOffsetDeg)[2])
                                           : "";
  const std::string angles = frustumDeg ? fmt::format("frustum={},{},{},{}", (*frustumDeg)[0], (*frustumDeg)[1],
                                                      (*frustumDeg)[2], (*frustumDeg)[3])
                                        : fmt::format("fov={}", fovDeg);
  return fmt::format(
      "size={}x{} {}{} near={} sse={} sampler={} samples={} culling={} depth-map={} selector={}{} horizon={} "
      "predictor={} cache-ram={} "
      "cache-gpu={} bands={} offline={} redraw={}",
      widthPx, heightPx, angles, offset, nearM, ssePx, nameOf(sampler), samples, nameOf(culling), map,
      selectorMode == SelectorMode::paper ? "paper" : "adaptive", selectorRules.empty() ? "" : ":" + selectorRules,
      horizon == HorizonTest::paper ? "paper" : "ellipsoid",
      predictor == PredictorMode::none ? "none" : fmt::format("kalman-{}", predictorStates), cacheRamMiB, cacheGpuMiB,
      bands == 0 ? "auto" : std::to_string(bands), offline, redrawAlways ? "always" : "changed");
}

ParsedOptions parseOptions(int argc, const char* const* argv) {
  ParsedOptions parsed;
  Options& options = parsed.options;
  CLI::App app{"Eyepoint draws a flight simulator's out-the-window view from a terrain database.", "eyepoint"};
  app.footer(
      "Keys: F1 statistics, F2 freezes culling, F3 depth map, F4 colours by level, by fate, F11 full screen, Esc "
      "quits\n\n"
      "Examples:\n"
      "  eyepoint                                                    a tour of the embedded terrain in a window\n"
      "  eyepoint --terrain alps.eyt --pose 45.98,7.66,4000,200,-10,0\n"
      "  eyepoint --host native-fdm://:5550                          flown by JSBSim or FlightGear\n"
      "  eyepoint --headless --offline --pose 49.25,20.1,2600,180,0,0 --terrain tatra.eyt --screenshot tatra.png");
  std::string config;
  app.add_option("--config", config, "TOML file with a key for each option; the command line wins")->type_name("FILE");
  app.set_version_flag("--version", versionLine("eyepoint"));
  addOptions(app, options);
  const auto refuse = [&](const std::string& message) {
    parsed.exitStatus = 2;
    parsed.text = oneLine(message);
    return parsed;
  };
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    parsed.exitStatus = 0;
    parsed.text = app.help();
    return parsed;
  } catch (const CLI::CallForVersion& version) {
    parsed.exitStatus = 0;
    parsed.text = std::string(version.what()) + "\n";
    return parsed;
  } catch (const CLI::ExtrasError& error) {
    std::vector<std::string> known;
    for (const CLI::Option* option : app.get_options()) known.push_back(option->get_name(false, true));
    std::string word = app.remaining().empty() ? "" : app.remaining().front();
    const std::string nearest = nearestWord(word.substr(0, word.find('=')), known);
    return refuse(
        word.empty() ? std::string(error.what())
                     : fmt::format("'{}' is no option of eyepoint; {}", word,
                                   nearest.empty() ? "see eyepoint --help" : fmt::format("did you mean {}?", nearest)));
  } catch (const CLI::Error& error) {
    return refuse(fmt::format("{}; see eyepoint --help", error.what()));
  }
  if (!config.empty()) {
    const Result<void> applied = applyConfig(app, config);
    if (!applied) return refuse(applied.error().message);
  }
  if (!options.pose.empty() && !options.hosts.empty())
    return refuse("--pose and --host both say where the eye is; give one of them");
  if (options.timeOfDayH && options.utcH)
    return refuse("--time-of-day and --utc both say what time it is; give one of them");
  if (!options.pose.empty()) options.hosts.push_back("pose://" + options.pose);
  return parsed;
}

}  // namespace eye
