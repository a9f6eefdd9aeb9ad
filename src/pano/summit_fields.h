// What the gazetteers' parsers share: fields as text into a summit that can be trusted.
#pragma once

#include "pano/gazetteer.h"

namespace eye {

// Valid UTF-8 without control characters, blanks trimmed, cut to kMaxNameBytes.
std::string cleanName(std::string_view text);
// Metres from "2655", "2655 m", "8,711 ft", "442 meters", "8711'"; nothing where it is anything else.
std::optional<double> heightFrom(std::string_view text);
inline constexpr double kHighestSummitM = 9000;  // nothing is higher: what is was told in feet
// The error says which field is wrong and how. An empty height is none.
Result<Summit> summitFrom(std::string_view name, std::string_view lat, std::string_view lon, std::string_view height);
Result<Summit> checkedSummit(Summit summit);
tl::unexpected<Error> failAtLine(size_t line, const std::string& what);

}  // namespace eye
