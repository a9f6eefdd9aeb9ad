// What the gazetteers' parsers share: fields as text into a summit that can be trusted.
#pragma once

#include "pano/gazetteer.h"

namespace eye {

// Valid UTF-8 without control characters, blanks trimmed, cut to kMaxNameBytes.
std::string cleanName(std::string_view text);
// The error says which field is wrong and how. An empty height is none.
Result<Summit> summitFrom(std::string_view name, std::string_view lat, std::string_view lon, std::string_view height);
Result<Summit> checkedSummit(Summit summit);
tl::unexpected<Error> failAtLine(size_t line, const std::string& what);

}  // namespace eye
