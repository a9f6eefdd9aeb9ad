// Lists of summits: CSV, GeoJSON, GeoNames, and the tables of summits that Alpano's users know. The parsers are pure:
// text in, summits or an error with its line out.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace eye {

struct Summit {
  std::string name;  // UTF-8, no control characters, at most kMaxNameBytes
  double latDeg = 0, lonDeg = 0;
  std::optional<double> heightM;
};

inline constexpr size_t kMaxGazetteerBytes = size_t{512} << 20;
inline constexpr size_t kMaxNameBytes = 120;

// By what it looks like: '{' begins GeoJSON; a line with GeoNames' 19 columns between tabs, GeoNames; two angles as
// degrees:minutes:seconds, Alpano's table; else CSV.
Result<std::vector<Summit>> parseGazetteer(std::string_view text);
// A header with name, lat and lon (or latitude, longitude), perhaps height (height_m, ele, elevation, alt), in any
// order; commas or semicolons between; cells may stand in double quotes.
Result<std::vector<Summit>> parseCsvGazetteer(std::string_view text);
// Points of a FeatureCollection; properties name and perhaps ele, height or elevation. Without a name: left out.
Result<std::vector<Summit>> parseGeoJsonGazetteer(std::string_view text);
// The dump of geonames.org; class T alone (mountains, hills).
Result<std::vector<Summit>> parseGeoNamesGazetteer(std::string_view text);
// "  7:25:12 45:08:25  1325  R0 E07 BA MONTE CURT": longitude, latitude, height, three words, the name.
Result<std::vector<Summit>> parseAlpanoGazetteer(std::string_view text);

Result<std::vector<Summit>> loadGazetteer(const std::string& path);
Result<std::vector<Summit>> loadGazetteers(const std::vector<std::string>& paths);  // behind one another

}  // namespace eye
