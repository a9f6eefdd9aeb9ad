#include "bench/figures.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "bench/machine_speed.h"
#include "bench/read_json.h"

namespace eye {
namespace {

using Json = nlohmann::ordered_json;

// Times of the same work on the same machine differ by as much, once divided by the speed reference: caches and memory
// are shared with whatever else runs, and the reference uses them otherwise than a frame does. A machine that is quiet
// differs by a tenth from one run to the next; what runs this is not one machine.
constexpr double kTimeBand = 0.4;
// What occlusion culling leaves hangs on drawn depths, whose last bits differ between processors.
constexpr double kPixelBand = 0.02;

// A rule takes one key out of the rows of a suite. Rows whose `keys` are the same make one figure, their sum.
struct Rule {
  const char* suite;
  const char* figure;
  FigureKind kind;
  std::vector<const char*> keys;
  bool (*counts)(const Json& row);  // null: every row
  const char* part = "rows";        // of the suite; or of its summary
};

bool isChosenInTime(const Json& row) {  // by a selector that looks at the clock
  return row.value("scheme", "") == "dynamic" || row.value("depth_map", "") == "auto";
}
bool hasDepthMap(const Json& row) {
  return row.value("scheme", "") == "dynamic_320x240" || row.value("culling", "") == "dynamic";
}
bool isCounted(const Json& row) {
  return !isChosenInTime(row) && !hasDepthMap(row);
}
bool isDrawn(const Json& row) {
  return !isChosenInTime(row) && hasDepthMap(row);
}
bool isTimed(const Json& row) {
  return !isChosenInTime(row);
}

const std::vector<Rule>& rules() {
  using enum FigureKind;
  static const std::vector<Rule> kRules{
      {"culling", "triangles", count, {"place", "altitude_ft", "size", "scheme"}, isCounted},
      {"culling", "triangles", pixels, {"place", "altitude_ft", "size", "scheme"}, isDrawn},
      {"culling", "cpu_ms", time, {"size", "scheme"}, isTimed},
      {"selector", "cpu_ms", time, {"mode"}, nullptr},
      {"flight", "slots", count, {"task", "rate_hz", "predictor"}, nullptr},
      {"globe", "blocks", count, {"distance_km"}, nullptr},
      {"globe", "visible", count, {"distance_km"}, nullptr},
      {"globe", "drawn", count, {"distance_km"}, nullptr},
      {"globe", "cpu_ms", time, {}, nullptr},
      {"globe", "hole_pixels", count, {"flight"}, nullptr, "flights"},
      {"panorama", "peaks", count, {"method", "camera"}, nullptr},
      {"panorama", "mape", pixels, {"method", "camera"}, nullptr},
      {"pareto", "triangles", count, {"sse", "culling", "depth_map", "sampler", "samples", "size"}, isCounted},
      {"pareto", "triangles", pixels, {"sse", "culling", "depth_map", "sampler", "samples", "size"}, isDrawn},
      {"pareto", "cpu_ms", time, {"sse"}, isTimed},
      {"stability", "holds", count, {"case"}, nullptr},
  };
  return kRules;
}

std::string wordOf(const Json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

std::string nameOf(const Rule& rule, const Json& row) {
  std::string keys;
  for (const char* key : rule.keys)
    if (row.contains(key)) keys += (keys.empty() ? "" : ", ") + std::string(key) + " " + wordOf(row[key]);
  return fmt::format("{}: {}{}{}", rule.suite, rule.figure, keys.empty() ? "" : ", ", keys);
}

// NaN where it is not there: published rows and null figures.
double numberAt(const Json& row, const char* key) {
  const auto found = row.find(key);
  if (found == row.end()) return NAN;
  if (found->is_boolean()) return found->get<bool>() ? 1 : 0;
  return found->is_number() ? found->get<double>() : NAN;
}

void add(Figure figure, std::vector<Figure>& figures) {
  for (Figure& there : figures) {
    if (there.name != figure.name) continue;
    there.value += figure.value;
    return;
  }
  figures.push_back(std::move(figure));
}

// Of the suite that the report calls `suite`. Nothing: it was measured by an older program, without the speed.
std::optional<double> referenceMs(const Json& suite) {
  const auto speed = suite.find("speed");
  if (speed == suite.end() || !speed->is_object()) return std::nullopt;
  MachineSpeed machine{.loopMs = numberAt(*speed, "loop_ms")};
  if (const double drawMs = numberAt(*speed, "draw_ms"); std::isfinite(drawMs)) machine.drawMs = drawMs;
  if (!(machine.referenceMs() > 0)) return std::nullopt;
  return machine.referenceMs();
}

Result<void> addFigures(const Json& suite, const Rule& rule, const std::string& file, std::vector<Figure>& figures) {
  const bool inRows = std::string_view(rule.part) == "rows";
  const auto broken = [&](const std::string& what) {
    return fail(ErrorKind::badData,
                fmt::format("{}: suite {}: {}; write the report anew with eyepoint-bench", file, rule.suite, what));
  };
  if (!suite.is_object()) return broken("it is no object");
  const auto holder = inRows ? suite.find("rows") : suite.find("summary");
  if (holder == suite.end()) return broken(inRows ? "'rows' is missing" : "'summary' is missing");
  const Json* rows = &*holder;
  if (!inRows) {
    if (!rows->is_object()) return broken("'summary' is no object");
    const auto part = rows->find(rule.part);
    if (part == rows->end()) return {};
    rows = &*part;
  }
  if (!rows->is_array()) return broken(fmt::format("'{}' is no list", rule.part));
  const std::optional<double> reference = referenceMs(suite);
  if (rule.kind == FigureKind::time && !reference) return broken("it has no 'speed' of the machine");
  for (const Json& row : *rows) {
    if (!row.is_object()) return broken(fmt::format("'{}' holds what is no object", rule.part));
    if (rule.counts != nullptr && !rule.counts(row)) continue;
    const double value = numberAt(row, rule.figure);
    if (!std::isfinite(value)) continue;
    const bool isTime = rule.kind == FigureKind::time;
    const double band = isTime ? kTimeBand : rule.kind == FigureKind::pixels ? kPixelBand : 0;
    add({nameOf(rule, row), rule.kind, isTime ? value / *reference : value, band}, figures);
  }
  return {};
}

constexpr std::array kKindNames{"count", "pixels", "time"};

Result<Figure> storedFigure(const std::string& name, const Json& json, const std::string& file) {
  const double value = json.is_object() ? numberAt(json, "value") : NAN;
  const double band = json.is_object() ? numberAt(json, "band") : NAN;
  const std::string kind = json.is_object() && json.contains("kind") ? wordOf(json["kind"]) : "";
  const auto known = std::ranges::find(kKindNames, kind);
  if (!std::isfinite(value) || !(band >= 0) || known == kKindNames.end())
    return fail(
        ErrorKind::badData,
        fmt::format("{}: figure '{}' wants a value, a band of at least 0 and one of the kinds count, pixels and "
                    "time; write the baseline anew with --update",
                    file, name));
  return Figure{name, static_cast<FigureKind>(known - kKindNames.begin()), value, band};
}

std::string textAt(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? found->get<std::string>() : "";
}

}  // namespace

Result<Figures> figuresOf(const Json& json, const std::string& name) {
  const auto neither = [&] {
    return fail(ErrorKind::badData, fmt::format("{}: neither a report.json of eyepoint-bench nor a baseline: it has no "
                                                "'suites' and no 'figures'",
                                                name));
  };
  if (!json.is_object()) return neither();
  Figures made{textAt(json, "machine"), textAt(json, "device"), textAt(json, "settings"), {}};
  if (const auto stored = json.find("figures"); stored != json.end() && stored->is_object()) {
    for (const auto& [key, value] : stored->items()) {
      Result<Figure> figure = storedFigure(key, value, name);
      if (!figure) return tl::unexpected(figure.error());
      made.figures.push_back(std::move(*figure));
    }
    return made;
  }
  const auto suites = json.find("suites");
  if (suites == json.end() || !suites->is_object()) return neither();
  for (const Rule& rule : rules()) {
    const auto suite = suites->find(rule.suite);
    if (suite == suites->end()) continue;
    if (const Result<void> added = addFigures(*suite, rule, name, made.figures); !added)
      return tl::unexpected(added.error());
  }
  return made;
}

Result<Figures> readFigures(const std::string& path) {
  const Result<Json> json = readJson(path);
  if (!json) return tl::unexpected(json.error());
  return figuresOf(*json, path);
}

std::string baselineJson(const Figures& figures) {
  std::string text =
      fmt::format("{{\n \"machine\": {},\n \"device\": {},\n \"settings\": {},\n \"figures\": {{",
                  Json(figures.machine).dump(), Json(figures.device).dump(), Json(figures.settings).dump());
  for (size_t i = 0; i < figures.figures.size(); ++i) {
    const Figure& figure = figures.figures[i];
    text +=
        fmt::format("{}\n  {}: {{\"kind\": \"{}\", \"value\": {:.6g}, \"band\": {:g}}}", i == 0 ? "" : ",",
                    Json(figure.name).dump(), kKindNames[static_cast<size_t>(figure.kind)], figure.value, figure.band);
  }
  return text + "\n }\n}\n";
}

}  // namespace eye
