// The ranges in which positions and poses are believed, whichever way they come in, and poses written as text.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/error.h"
#include "geo/pose.h"

namespace eye {

inline constexpr double kMinAltitudeM = -1000;  // the lowest dry land is at -430 m
inline constexpr double kMaxAltitudeM = 1e8;    // beyond geostationary and the farthest view that is tested (62,763 km)
inline constexpr double kMinVisibilityM = 1;
inline constexpr double kMaxVisibilityM = 1e7;

// Latitude within 90 degrees, longitude within 360 (comes back within 180), altitude within the limits above. The error
// names the part: "latitude 91 is outside -90 to 90 degrees".
Result<Geodetic> checkedPosition(Geodetic position);

// A number and nothing else, finite; or nothing.
std::optional<double> parseNumber(std::string_view text);

}  // namespace eye
