#include "link/pose_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "link/angles.h"

namespace eye {
namespace {

// Radians of a pole or of the date line may turn into degrees one rounding beyond it.
constexpr double kRoundingDeg = 1e-9;

Result<void> checkRange(const char* name, double value, double lowest, double highest, const char* unit) {
  if (value >= lowest && value <= highest) return {};
  if (!std::isfinite(value)) return fail(ErrorKind::badData, fmt::format("{} is not a finite number", name));
  return fail(ErrorKind::badData, fmt::format("{} {} is outside {} to {} {}", name, value, lowest, highest, unit));
}

std::string_view trimmed(std::string_view text) {
  const size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

}  // namespace

Result<Geodetic> checkedPosition(Geodetic position) {
  if (std::abs(position.latDeg) <= 90.0 + kRoundingDeg) position.latDeg = std::clamp(position.latDeg, -90.0, 90.0);
  if (std::abs(position.lonDeg) <= 360.0 + kRoundingDeg) position.lonDeg = std::clamp(position.lonDeg, -360.0, 360.0);
  for (const auto& ok : {checkRange("latitude", position.latDeg, -90, 90, "degrees"),
                         checkRange("longitude", position.lonDeg, -360, 360, "degrees"),
                         checkRange("altitude", position.altM, kMinAltitudeM, kMaxAltitudeM, "m")})
    if (!ok) return tl::unexpected(ok.error());
  if (std::abs(position.lonDeg) > 180.0) position.lonDeg = wrappedDeg180(position.lonDeg);
  return position;
}

std::optional<double> parseNumber(std::string_view text) {
  text = trimmed(text);
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, problem] = std::from_chars(text.data(), end, value);
  if (problem != std::errc() || stop != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace eye
