#include "pano/summit_fields.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include <fmt/format.h>

#include "link/pose_limits.h"

namespace eye {
namespace {

// Bytes of the well-formed character at the beginning of `text`; 0 where there is none (RFC 3629).
size_t characterBytes(std::string_view text) {
  const auto byte = [&](size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  const size_t size = first < 0x80 ? 1 : first < 0xC2 ? 0 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : first < 0xF5 ? 4 : 0;
  if (size == 0 || size > text.size()) return 0;
  for (size_t i = 1; i < size; ++i)
    if ((byte(i) & 0xC0) != 0x80) return 0;
  const bool isTooLong = (first == 0xE0 && byte(1) < 0xA0) || (first == 0xF0 && byte(1) < 0x90);
  const bool isNone = (first == 0xED && byte(1) > 0x9F) || (first == 0xF4 && byte(1) > 0x8F);
  return isTooLong || isNone ? 0 : size;
}

}  // namespace

std::string cleanName(std::string_view text) {
  std::string name;
  while (!text.empty()) {
    const size_t size = characterBytes(text);
    const bool isControl = size == 1 && (static_cast<unsigned char>(text[0]) < 0x20 || text[0] == 0x7F);
    const std::string_view character = size == 0 ? "?" : isControl ? " " : text.substr(0, size);
    if (name.size() + character.size() > kMaxNameBytes) break;
    if (character != " " || !(name.empty() || name.back() == ' ')) name += character;
    text.remove_prefix(size == 0 ? 1 : size);
  }
  if (name.ends_with(' ')) name.pop_back();
  return name;
}

std::optional<double> heightFrom(std::string_view text) {
  constexpr double kFootM = 0.3048;
  constexpr std::array<std::string_view, 7> kMetres{"", "m", "m.", "meter", "metre", "meters", "metres"};
  constexpr std::array<std::string_view, 6> kFeet{"ft", "ft.", "foot", "feet", "'", "\u2032"};
  const auto isDigit = [&](size_t i) { return i < text.size() && std::isdigit(static_cast<unsigned char>(text[i])); };
  const size_t end = std::min(text.find_first_not_of("+-0123456789., "), text.size());
  std::string digits, unit;
  for (size_t i = 0; i < end; ++i) {
    const bool setsThousandsApart =
        text[i] == ',' && isDigit(i + 1) && isDigit(i + 2) && isDigit(i + 3) && !isDigit(i + 4);
    if (!setsThousandsApart) digits += text[i];
  }
  for (const char c : text.substr(end))
    if (c != ' ') unit += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const std::optional<double> number = parseNumber(digits);
  if (!number) return std::nullopt;
  if (std::ranges::count(kMetres, unit) > 0) return number;
  if (std::ranges::count(kFeet, unit) > 0) return *number * kFootM;
  return std::nullopt;
}

Result<Summit> checkedSummit(Summit summit) {
  const auto at = checkedPosition({summit.latDeg, summit.lonDeg, summit.heightM.value_or(0)});
  if (!at) return tl::unexpected(at.error());
  summit.latDeg = at->latDeg, summit.lonDeg = at->lonDeg;
  if (summit.heightM && *summit.heightM > kHighestSummitM)
    return fail(ErrorKind::badData, fmt::format("height {} is above every summit; give metres", *summit.heightM));
  return summit;
}

Result<Summit> summitFrom(std::string_view name, std::string_view lat, std::string_view lon, std::string_view height) {
  const auto latDeg = parseNumber(lat), lonDeg = parseNumber(lon), heightM = heightFrom(height);
  if (!latDeg) return fail(ErrorKind::badData, fmt::format("latitude '{}' is not a number", lat.substr(0, 40)));
  if (!lonDeg) return fail(ErrorKind::badData, fmt::format("longitude '{}' is not a number", lon.substr(0, 40)));
  if (!height.empty() && !heightM)
    return fail(ErrorKind::badData, fmt::format("height '{}' is not one in metres or feet", height.substr(0, 40)));
  return checkedSummit({cleanName(name), *latDeg, *lonDeg, heightM});
}

tl::unexpected<Error> failAtLine(size_t line, const std::string& what) {
  return fail(ErrorKind::badData, fmt::format("line {}: {}", line, what));
}

}  // namespace eye
