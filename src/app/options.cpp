#include "app/options.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <sstream>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "app/config_file.h"
#include "base/nearest_word.h"
#include "base/version.h"

namespace eye {
namespace {

constexpr int kLargestSidePx = 8192;

// Numbers behind one another with one separator, nothing else. Finite.
std::optional<std::vector<double>> splitNumbers(const std::string& text, char separator, size_t count) {
  std::vector<double> numbers;
  std::stringstream stream(text);
  std::string word;
  while (std::getline(stream, word, separator)) {
    char* end = nullptr;
    const double value = std::strtod(word.c_str(), &end);
    if (word.empty() || *end != '\0' || !std::isfinite(value)) return std::nullopt;
    numbers.push_back(value);
  }
  if (numbers.size() != count || (!text.empty() && text.back() == separator)) return std::nullopt;
  return numbers;
}

constexpr const char* kNumber = "number";  // the name of validators of numbers

// CLI::Range lets NaN through, since NaN is not less than anything.
CLI::Validator within(double least, double most) {
  return CLI::Validator(
      [=](std::string& text) {
        const auto number = splitNumbers(text, ' ', 1);
        return number && (*number)[0] >= least && (*number)[0] <= most
                   ? std::string()
                   : fmt::format("'{}' is not a number from {} to {}", text, least, most);
      },
      fmt::format("{}..{}", least, most), kNumber);
}

CLI::Validator wholeWithin(uint64_t least, uint64_t most) {
  return CLI::Validator(
      [=](std::string& text) {
        uint64_t number = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
        return error == std::errc() && end == text.data() + text.size() && number >= least && number <= most
                   ? std::string()
                   : fmt::format("'{}' is not a whole number from {} to {}", text, least, most);
      },
      fmt::format("{}..{}", least, most), kNumber);
}

// WxH, both whole and from `least` to kLargestSidePx.
std::optional<glm::ivec2> sizeOf(const std::string& text, int least) {
  const auto numbers = splitNumbers(text, 'x', 2);
  if (!numbers) return std::nullopt;
  for (const double side : *numbers)
    if (std::floor(side) != side || side < least || side > kLargestSidePx) return std::nullopt;
  return glm::ivec2(static_cast<int>((*numbers)[0]), static_cast<int>((*numbers)[1]));
}

void setSize(Options& options, const std::string& text) {
  const auto size = sizeOf(text, 16);
  if (!size)
    throw CLI::ValidationError("--size", fmt::format("'{}' is no size; give WxH from 16x16 to {}x{}, such as 1280x720",
                                                     text, kLargestSidePx, kLargestSidePx));
  options.widthPx = size->x;
  options.heightPx = size->y;
}

CullingMode cullingOf(const std::string& text) {
  return text == "none" ? CullingMode::none : text == "frustum" ? CullingMode::frustum : CullingMode::dynamic;
}

std::string nameOf(CullingMode culling) {
  return culling == CullingMode::none ? "none" : culling == CullingMode::frustum ? "frustum" : "dynamic";
}

void setDepthMap(Options& options, const std::string& text) {
  if (text == "auto" || text == "off") {
    options.depthMap = text == "auto" ? DepthMapMode::automatic : DepthMapMode::off;
    return;
  }
  const auto size = sizeOf(text, 1);
  if (!size)
    throw CLI::ValidationError(
        "--depth-map", fmt::format("'{}' is no depth map; give auto, off or WxH from 1x1 to {}x{}, such as 400x300",
                                   text, kLargestSidePx, kLargestSidePx));
  options.depthMap = DepthMapMode::fixed;
  options.depthMapPx = *size;
}

void setDebugView(Options& options, const std::string& text) {
  const std::optional<DebugView> view = debugViewOf(text);
  if (!view)
    throw CLI::ValidationError("--debug-view",
                               fmt::format("'{}' is no debug view; give freeze, depth-map, and level or fate, with "
                                           "commas between them",
                                           text));
  options.debugView = *view;
}

void setFrustum(Options& options, const std::string& text) {
  const auto n = splitNumbers(text, ',', 4);
  if (!n || (*n)[0] >= (*n)[1] || (*n)[2] >= (*n)[3] || std::abs((*n)[0]) >= 89.9 || std::abs((*n)[1]) >= 89.9 ||
      std::abs((*n)[2]) >= 89.9 || std::abs((*n)[3]) >= 89.9)
    throw CLI::ValidationError("--frustum",
                               fmt::format("'{}' is no frustum; give left,right,bottom,top half-angles in degrees, "
                                           "signed, within 89.9, such as -30,30,-23.4,23.4",
                                           text));
  options.frustumDeg = std::array<double, 4>{(*n)[0], (*n)[1], (*n)[2], (*n)[3]};
}

void setViewOffset(Options& options, const std::string& text) {
  const auto n = splitNumbers(text, ',', 3);
  if (!n || std::abs((*n)[0]) > 360 || std::abs((*n)[1]) > 90 || std::abs((*n)[2]) > 360)
    throw CLI::ValidationError("--view-offset",
                               fmt::format("'{}' is no offset; give heading,pitch,roll in degrees, within 360, 90 and "
                                           "360, such as -60,0,0 for a view to the left",
                                           text));
  options.viewOffsetDeg = std::array<double, 3>{(*n)[0], (*n)[1], (*n)[2]};
}

void setRate(Options& options, const std::string& text) {
  options.rateOfHost = text == "host";
  options.rateHz.reset();
  if (options.rateOfHost) return;
  if (text == "max") {
    options.rateHz = std::numeric_limits<double>::infinity();
    return;
  }
  const auto number = splitNumbers(text, ' ', 1);
  if (!number || (*number)[0] <= 0 || (*number)[0] > 1000)
    throw CLI::ValidationError("--rate", fmt::format("'{}' is no rate; give hertz in (0, 1000], max or host", text));
  options.rateHz = (*number)[0];
}

void setHostDelay(Options& options, const std::string& text) {
  if (text == "auto" || text == "off") {
    options.hostDelay = text == "off" ? HostDelayMode::off : HostDelayMode::automatic;
    return;
  }
  const auto number = splitNumbers(text, ' ', 1);
  if (!number || (*number)[0] < 0 || (*number)[0] > 500)
    throw CLI::ValidationError("--host-delay",
                               fmt::format("'{}' is no delay; give milliseconds from 0 to 500, auto or off", text));
  options.hostDelay = HostDelayMode::fixed;
  options.hostDelayMs = (*number)[0];
}

void setBackground(Options& options, const std::string& text) {
  const auto n = splitNumbers(text, ',', 3);
  if (!n || std::ranges::any_of(*n, [](double part) { return part < 0 || part > 1; }))
    throw CLI::ValidationError("--background", fmt::format("'{}' is no colour; give R,G,B from 0 to 1", text));
  options.background = glm::vec3(glm::dvec3((*n)[0], (*n)[1], (*n)[2]));
}

void setDate(Options& options, const std::string& text) {
  const auto n = text.size() == 10 ? splitNumbers(text, '-', 3) : std::nullopt;
  const auto whole = [&](size_t i) { return static_cast<int>((*n)[i]); };
  if (n) options.date = CalendarDate{whole(0), whole(1), whole(2)};
  const bool valid =
      n && whole(0) >= 1900 && whole(0) <= 2100 &&
      std::chrono::year_month_day(std::chrono::year(whole(0)), std::chrono::month(static_cast<unsigned>(whole(1))),
                                  std::chrono::day(static_cast<unsigned>(whole(2))))
          .ok() &&
      fmt::format("{:04}-{:02}-{:02}", whole(0), whole(1), whole(2)) == text;
  if (!valid)
    throw CLI::ValidationError(
        "--date", fmt::format("'{}' is no date; give YYYY-MM-DD from 1900 to 2100, such as 2026-06-21", text));
}

bool onOff(const std::string& name, const std::string& text) {
  if (text == "on" || text == "true") return true;
  if (text == "off" || text == "false") return false;
  throw CLI::ValidationError(name, fmt::format("'{}' is neither on nor off", text));
}

void addTerrainAndHost(CLI::App& app, Options& o) {
  const char* group = "Terrain and aircraft state";
  app.add_option("--terrain", o.terrain, "Terrain database made by eyepoint-bake; default: the embedded demo")
      ->type_name("FILE")
      ->group(group);
  app.add_option(
         "--host", o.hosts,
         "Where aircraft state comes from (may be given again):\n"
         "native-fdm://, cigi://, dis:// or xplane://ADDR:PORT, file://TRACK, demo://, pose://lat,lon,alt,h,p,r")
      ->type_name("URL")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->group(group);
  app.add_option_function<std::string>(
         "--host-delay", [&o](const std::string& t) { setHostDelay(o, t); },
         "A live host's aircraft is drawn where it was, or will have been, this long before each\n"
         "frame: auto (default) by how unevenly packets come; off: where the newest packet has it")
      ->type_name("auto/off/MS")
      ->group(group);
  app.add_option("--pose", o.pose, "Holds still: lat,lon,alt,heading,pitch,roll (degrees, metres)")
      ->type_name("P")
      ->group(group);
}

void addView(CLI::App& app, Options& o) {
  const char* group = "View";
  app.add_option_function<std::string>(
         "--size", [&o](const std::string& t) { setSize(o, t); }, "Pixels; default 800x600")
      ->type_name("WxH")
      ->group(group);
  app.add_option("--fov", o.fovDeg, "Full horizontal angle, degrees; default 60")
      ->type_name("DEG")
      ->check(within(0.1, 170.0))
      ->group(group);
  app.add_option_function<std::string>(
         "--frustum", [&o](const std::string& t) { setFrustum(o, t); },
         "Off-axis view: left,right,bottom,top half-angles, signed degrees")
      ->type_name("L,R,B,T")
      ->group(group);
  app.add_option_function<std::string>(
         "--view-offset", [&o](const std::string& t) { setViewOffset(o, t); },
         "Where this channel looks from the aircraft's nose: heading,pitch,roll, degrees")
      ->type_name("H,P,R")
      ->group(group);
  app.add_option("--near", o.nearM, "Near plane, metres; default 1")
      ->type_name("M")
      ->check(within(0.01, 1000.0))
      ->group(group);
  app.add_flag("--headless", o.headless, "No window; works without a display")->group(group);
  app.add_flag("--fullscreen", o.fullscreen, "The whole monitor (F11 switches)")->group(group);
  app.add_option("--monitor", o.monitor, "Which monitor, from 0")
      ->type_name("N")
      ->check(wholeWithin(0, 63))
      ->group(group);
  app.add_option_function<std::string>(
         "--vsync", [&o](const std::string& t) { o.vsync = onOff("--vsync", t); }, "on (default) or off")
      ->type_name("on/off")
      ->group(group);
  app.add_flag("--overlay", o.overlay, "Statistics over the picture from the start (F1 switches)")->group(group);
}

void addRun(CLI::App& app, Options& o) {
  const char* group = "Run";
  app.add_option("--frames", o.frames, "Stop after N frames")
      ->type_name("N")
      ->check(wholeWithin(1, 1'000'000'000'000'000))
      ->group(group);
  app.add_option("--duration", o.durationS, "Stop after S seconds")
      ->type_name("S")
      ->check(within(0.001, 1e9))
      ->group(group);
  app.add_option_function<std::string>(
         "--rate", [&o](const std::string& t) { setRate(o, t); },
         "Pace of frames: hertz, max, or host: one for each message of a live host; default 60,\n"
         "max with a fixed pose or --offline")
      ->type_name("HZ/max/host")
      ->group(group);
  app.add_option_function<std::string>(
         "--redraw", [&o](const std::string& t) { o.redrawAlways = t == "always"; },
         "changed (default): a frame like the last one is not drawn again; always")
      ->type_name("changed/always")
      ->check(CLI::IsMember({"changed", "always"}))
      ->group(group);
  app.add_flag("--offline", o.offline, "Deterministic: fixed 60 Hz clock, every frame waits for its terrain")
      ->group(group);
}

void addQuality(CLI::App& app, Options& o) {
  const char* group = "Quality and budgets";
  app.add_option("--sse", o.ssePx, "Tolerated screen-space error, pixels; default 1")
      ->type_name("PX")
      ->check(within(0.05, 64.0))
      ->group(group);
  app.add_option_function<std::string>(
         "--culling", [&o](const std::string& t) { o.culling = cullingOf(t); },
         "none, frustum (view frustum and horizon), or dynamic (default): hidden and\n"
         "back-facing clusters too, where that pays; the picture is the same")
      ->type_name("none/frustum/dynamic")
      ->check(CLI::IsMember({"none", "frustum", "dynamic"}))
      ->group(group);
  app.add_option_function<std::string>(
         "--depth-map", [&o](const std::string& t) { setDepthMap(o, t); },
         "Size of dynamic culling's depth map: auto (default) chooses each frame, off, or WxH")
      ->type_name("auto/off/WxH")
      ->group(group);
  app.add_option_function<std::string>(
         "--selector",
         [&o](const std::string& t) { o.selectorMode = t == "paper" ? SelectorMode::paper : SelectorMode::adaptive; },
         "How auto chooses: adaptive (default) by what pays, paper by altitude and pitch")
      ->type_name("adaptive/paper")
      ->check(CLI::IsMember({"adaptive", "paper"}))
      ->group(group);
  app.add_option("--selector-rules", o.selectorRules, "Rules for auto, such as config/selector.toml; default built in")
      ->type_name("FILE.toml")
      ->group(group);
  app.add_option_function<std::string>(
         "--horizon",
         [&o](const std::string& t) { o.horizon = t == "paper" ? HorizonTest::paper : HorizonTest::ellipsoid; },
         "What hides chunks below the horizon: ellipsoid (default), or paper: a sphere, for comparison")
      ->type_name("ellipsoid/paper")
      ->check(CLI::IsMember({"ellipsoid", "paper"}))
      ->group(group);
  app.add_option_function<std::string>(
         "--predictor",
         [&o](const std::string& t) { o.predictor = t == "none" ? PredictorMode::none : PredictorMode::kalman; },
         "Terrain is loaded ahead along the predicted flight: kalman (default), or around the eye alone: none")
      ->type_name("kalman/none")
      ->check(CLI::IsMember({"kalman", "none"}))
      ->group(group);
  app.add_option("--predictor-states", o.predictorStates,
                 "The predictor's model: 6 (constant velocity), 9 (constant acceleration, default), 12 (constant jerk)")
      ->type_name("6/9/12")
      ->check(wholeWithin(6, 12))
      ->check(CLI::IsMember({6, 9, 12}))
      ->group(group);
  app.add_option("--process-noise", o.processNoise,
                 "What the predictor's model leaves out, m2/s5 with 9 states; default: estimated from the flight")
      ->type_name("Q")
      ->check(within(1e-9, 1e9))
      ->group(group);
  app.add_option("--measurement-sigma", o.measurementSigmaM,
                 "Noise of the host's positions, metres; default: estimated from the flight")
      ->type_name("M")
      ->check(within(1e-6, 1e4))
      ->group(group);
  app.add_option("--cache-ram", o.cacheRamMiB, "Budget for decoded terrain in memory; default 96")
      ->type_name("MIB")
      ->check(wholeWithin(8, 1 << 20))
      ->group(group);
  app.add_option("--cache-gpu", o.cacheGpuMiB, "Budget for terrain on the GPU; default 160")
      ->type_name("MIB")
      ->check(wholeWithin(16, 1 << 20))
      ->group(group);
  app.add_option("--time-of-day", o.timeOfDayH, "Local solar time at the eye, hours; default the host's, else 9")
      ->type_name("H")
      ->check(within(0.0, 24.0))
      ->group(group);
  app.add_option("--utc", o.utcH, "Universal time instead, hours: one sun for the whole globe")
      ->type_name("H")
      ->check(within(0.0, 24.0))
      ->group(group);
  app.add_option_function<std::string>(
         "--date", [&o](const std::string& t) { setDate(o, t); },
         "The sun's date, 1900 to 2100; default the host's, else 2026-03-20, an equinox")
      ->type_name("YYYY-MM-DD")
      ->group(group);
  app.add_option("--visibility", o.visibilityM, "Meteorological visibility, metres; default the host's, else 60000")
      ->type_name("M")
      ->check(within(10.0, 1.0e6))
      ->group(group);
}

void addOutputs(CLI::App& app, Options& o) {
  const char* group = "Outputs";
  app.add_option("--screenshot", o.screenshot, "The last frame as a picture")->type_name("FILE.png")->group(group);
  app.add_option("--distance-map", o.distanceMap, "The last frame's slant range in metres, NaN for sky")
      ->type_name("FILE.tif")
      ->group(group);
  app.add_option("--record", o.record, "All frames as a film (needs ffmpeg)")->type_name("FILE.mp4")->group(group);
  app.add_option("--frames-dir", o.framesFolder, "All frames as pictures")->type_name("DIR")->group(group);
  app.add_option("--stats", o.stats, "One JSON object a frame")->type_name("FILE.jsonl")->group(group);
  app.add_option("--summary", o.summary, "One JSON object for the run")->type_name("FILE.json")->group(group);
  app.add_option("--trace", o.trace, "Chrome/Perfetto trace of threads and GPU passes")
      ->type_name("FILE.json")
      ->group(group);
}

void addDiagnosis(CLI::App& app, Options& o) {
  const char* group = "Device and diagnosis";
  app.add_flag("--list-devices", o.listDevices, "The Vulkan devices, and which can be used")->group(group);
  app.add_option("--device", o.device, "Use the device whose name contains NAME")->type_name("NAME")->group(group);
  app.add_flag("--validate", o.validate, "Vulkan validation on; any message fails the run")->group(group);
  app.add_option("--log-level", o.logLevel, "debug, info (default), warn or error")
      ->check(CLI::IsMember({"debug", "info", "warn", "error"}))
      ->group(group);
  app.add_option_function<std::string>(
         "--debug-view", [&o](const std::string& t) { setDebugView(o, t); },
         "What culling does: freeze what is drawn (F2), depth-map (F3), colours by level\n"
         "or by fate (F4); several with commas")
      ->type_name("V,...")
      ->group(group);
  app.add_option_function<std::string>(
         "--background", [&o](const std::string& t) { setBackground(o, t); },
         "A flat colour instead of sky and haze: shows holes")
      ->type_name("R,G,B")
      ->group(group);
}

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

std::string defaultTerrainPath() {
  const char* data = std::getenv("XDG_DATA_HOME");
  const char* home = std::getenv("HOME");
  const std::string folder =
      data != nullptr && *data != '\0' ? data : std::string(home != nullptr ? home : ".") + "/.local/share";
  return folder + "/eyepoint/demo.eyt";
}

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
      "size={}x{} {}{} near={} sse={} culling={} depth-map={} selector={}{} horizon={} predictor={} cache-ram={} "
      "cache-gpu={} offline={} redraw={}",
      widthPx, heightPx, angles, offset, nearM, ssePx, nameOf(culling), map,
      selectorMode == SelectorMode::paper ? "paper" : "adaptive", selectorRules.empty() ? "" : ":" + selectorRules,
      horizon == HorizonTest::paper ? "paper" : "ellipsoid",
      predictor == PredictorMode::none ? "none" : fmt::format("kalman-{}", predictorStates), cacheRamMiB, cacheGpuMiB,
      offline, redrawAlways ? "always" : "changed");
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
  addTerrainAndHost(app, options);
  addView(app, options);
  addRun(app, options);
  addQuality(app, options);
  addOutputs(app, options);
  addDiagnosis(app, options);
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
