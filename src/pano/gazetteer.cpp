#include "pano/gazetteer.h"

#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <nlohmann/json.hpp>

#include "link/pose_limits.h"
#include "link/text_lines.h"
#include "pano/summit_fields.h"

namespace eye {
namespace {

constexpr size_t kGeoNamesColumns = 19;
constexpr size_t kNameColumn = 36;  // of Alpano's table, whose columns are fixed

std::string_view firstLine(std::string_view text) {
  TextLines lines(text);
  while (const auto line = lines.next())
    if (line->find_first_not_of(" \t") != std::string_view::npos) return *line;
  return {};
}

std::vector<std::string_view> splitAt(std::string_view line, char separator, size_t most) {
  std::vector<std::string_view> cells;
  while (cells.size() + 1 < most) {
    const size_t end = line.find(separator);
    cells.push_back(line.substr(0, end));
    if (end == std::string_view::npos) return cells;
    line.remove_prefix(end + 1);
  }
  cells.push_back(line);
  return cells;
}

// The word at the beginning of `line`, which is taken away with the blanks around it.
std::string_view takeWord(std::string_view& line) {
  const size_t begin = std::min(line.find_first_not_of(' '), line.size());
  const size_t end = std::min(line.find(' ', begin), line.size());
  const std::string_view word = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return word;
}

std::optional<double> wholeNumber(std::string_view text, int most) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < 0 || value > most) return std::nullopt;
  return value;
}

// 7:25:12, -0:12:05
std::optional<double> sexagesimalDeg(std::string_view text) {
  const bool isNegative = text.starts_with('-');
  const auto parts = splitAt(text.substr(isNegative ? 1 : 0), ':', 4);
  if (parts.size() != 3) return std::nullopt;
  const auto degrees = wholeNumber(parts[0], 180), minutes = wholeNumber(parts[1], 59),
             seconds = wholeNumber(parts[2], 59);
  if (!degrees || !minutes || !seconds) return std::nullopt;
  const double deg = *degrees + *minutes / 60 + *seconds / 3600;
  return isNegative ? -deg : deg;
}

bool looksLikeAlpano(std::string_view line) {
  return sexagesimalDeg(takeWord(line)) && sexagesimalDeg(takeWord(line));
}

// Of GeoNames' class T, which has valleys, passes and plains too. Of groups of mountains the place is the middle, which
// is no summit but where they are given a height.
constexpr std::array<std::string_view, 8> kSummitCodes{"PK", "MT", "HLL", "VLC", "CONE", "BUTE", "NTK", "MND"};
constexpr std::array<std::string_view, 4> kGroupCodes{"PKS", "MTS", "HLLS", "NTKS"};

bool isSummit(std::string_view code, bool hasHeight) {
  return std::ranges::count(kSummitCodes, code) > 0 || (hasHeight && std::ranges::count(kGroupCodes, code) > 0);
}

// Metres; nothing where a feature tells none. What it tells and cannot be read is noted.
std::optional<double> heightOf(const nlohmann::json& properties, const nlohmann::json& coordinates,
                               GazetteerDoubts& doubts) {
  const auto believed = [&](std::optional<double> heightM, const std::string& text) {
    if (heightM && *heightM <= kHighestSummitM && *heightM >= kMinAltitudeM) return heightM;
    if (doubts.heights++ == 0) doubts.firstHeight = cleanName(text);
    return std::optional<double>{};
  };
  for (const char* key : {"ele", "height", "elevation"}) {
    const auto found = properties.find(key);
    if (found == properties.end() || !(found->is_number() || found->is_string())) continue;
    const std::string text = found->is_string() ? found->get<std::string>() : found->dump();
    if (text.find_first_not_of(' ') == std::string::npos) continue;
    const std::optional<double> heightM = believed(heightFrom(text), text);
    if (heightM == 0.0) continue;  // what importers write who know none
    return heightM;
  }
  if (coordinates.size() < 3 || !coordinates[2].is_number() || coordinates[2] == 0.0) return std::nullopt;
  return believed(coordinates[2].get<double>(), coordinates[2].dump());
}

std::optional<Summit> summitOf(const nlohmann::json& feature, GazetteerDoubts& doubts) {
  const auto geometry = feature.find("geometry"), properties = feature.find("properties");
  if (geometry == feature.end() || properties == feature.end() || !geometry->is_object() || !properties->is_object())
    return std::nullopt;
  const auto coordinates = geometry->find("coordinates"), name = properties->find("name");
  if (coordinates == geometry->end() || !coordinates->is_array() || coordinates->size() < 2 ||
      !(*coordinates)[0].is_number() || !(*coordinates)[1].is_number() || name == properties->end() ||
      !name->is_string())
    return std::nullopt;
  const Result<Summit> checked = checkedSummit({cleanName(name->get<std::string>()), (*coordinates)[1],
                                                (*coordinates)[0], heightOf(*properties, *coordinates, doubts)});
  if (!checked || checked->name.empty()) return std::nullopt;
  return *checked;
}

}  // namespace

Result<std::vector<Summit>> parseGeoJsonGazetteer(std::string_view text, GazetteerDoubts& doubts) {
  const nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
  if (json.is_discarded() || !json.is_object())
    return fail(ErrorKind::badData, "it begins like GeoJSON and is not valid JSON; export it again");
  const auto features = json.find("features");
  if (features == json.end() || !features->is_array())
    return fail(ErrorKind::badData, "GeoJSON without an array 'features'; export a FeatureCollection of points");
  std::vector<Summit> summits;
  for (const nlohmann::json& feature : *features) {
    if (!feature.is_object()) continue;
    if (auto summit = summitOf(feature, doubts)) summits.push_back(std::move(*summit));
  }
  return summits;
}

Result<std::vector<Summit>> parseGeoNamesGazetteer(std::string_view text) {
  TextLines lines(text);
  std::vector<Summit> summits;
  while (const auto line = lines.next()) {
    if (line->empty()) continue;
    const auto cells = splitAt(*line, '\t', kGeoNamesColumns);
    if (cells.size() != kGeoNamesColumns)
      return failAtLine(lines.number(),
                        fmt::format("{} columns between tabs; GeoNames' table has {}", cells.size(), kGeoNamesColumns));
    if (cells[6] != "T" || !isSummit(cells[7], !cells[15].empty())) continue;
    Result<Summit> summit = summitFrom(cells[1], cells[4], cells[5], cells[15]);
    if (!summit) return failAtLine(lines.number(), summit.error().message);
    summits.push_back(std::move(*summit));
  }
  return summits;
}

Result<std::vector<Summit>> parseAlpanoGazetteer(std::string_view text) {
  TextLines lines(text);
  std::vector<Summit> summits;
  while (auto line = lines.next()) {
    if (line->find_first_not_of(' ') == std::string_view::npos) continue;
    const std::string name = cleanName(line->substr(std::min(line->size(), kNameColumn)));
    const std::string_view lon = takeWord(*line), lat = takeWord(*line), height = takeWord(*line);
    const auto lonDeg = sexagesimalDeg(lon), latDeg = sexagesimalDeg(lat),
               heightM = wholeNumber(height, static_cast<int>(kHighestSummitM));
    if (!lonDeg || !latDeg || !heightM)
      return failAtLine(lines.number(),
                        fmt::format("'{} {} {}' is no longitude and latitude as degrees:minutes:seconds "
                                    "and height in metres",
                                    lon.substr(0, 20), lat.substr(0, 20), height.substr(0, 20)));
    Result<Summit> summit = checkedSummit({name, *latDeg, *lonDeg, heightM});
    if (!summit) return failAtLine(lines.number(), summit.error().message);
    summits.push_back(std::move(*summit));
  }
  return summits;
}

Result<std::vector<Summit>> parseGazetteer(std::string_view text, GazetteerDoubts& doubts) {
  const std::string_view line = firstLine(text);
  const std::string_view begin = line.substr(std::min(line.find_first_not_of(" \t"), line.size()));
  Result<std::vector<Summit>> summits = begin.starts_with('{') ? parseGeoJsonGazetteer(text, doubts)
                                        : splitAt(line, '\t', kGeoNamesColumns + 1).size() == kGeoNamesColumns
                                            ? parseGeoNamesGazetteer(text)
                                        : looksLikeAlpano(line) ? parseAlpanoGazetteer(text)
                                                                : parseCsvGazetteer(text);
  if (summits && summits->empty()) return fail(ErrorKind::badData, "there is not one named summit in it");
  return summits;
}

Result<std::vector<Summit>> loadGazetteer(const std::string& path) {
  std::error_code failed;
  const uintmax_t size = std::filesystem::is_regular_file(path, failed) ? std::filesystem::file_size(path, failed) : 0;
  std::ifstream file(path, std::ios::binary);
  if (failed || !file || !std::filesystem::is_regular_file(path, failed))
    return fail(ErrorKind::notFound, fmt::format("peaks '{}': no such file, or it cannot be read", path));
  if (size > kMaxGazetteerBytes)
    return fail(ErrorKind::badData,
                fmt::format("peaks '{}': more than {} MiB; cut out the region", path, kMaxGazetteerBytes >> 20));
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  GazetteerDoubts doubts;
  Result<std::vector<Summit>> summits = parseGazetteer(text, doubts);
  if (!summits) return fail(summits.error().kind, fmt::format("peaks '{}': {}", path, summits.error().message));
  if (doubts.heights > 0)
    spdlog::warn("peaks '{}': {} heights are none in metres or feet, such as '{}'; the terrain's are taken", path,
                 doubts.heights, doubts.firstHeight);
  return summits;
}

Result<std::vector<Summit>> loadGazetteers(const std::vector<std::string>& paths) {
  std::vector<Summit> all;
  for (const std::string& path : paths) {
    Result<std::vector<Summit>> summits = loadGazetteer(path);
    if (!summits) return summits;
    std::ranges::move(*summits, std::back_inserter(all));
  }
  return all;
}

}  // namespace eye
