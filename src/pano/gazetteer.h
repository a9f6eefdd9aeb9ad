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

// What was read and not believed: not worth an error, for the summit is there.
struct GazetteerDoubts {
  size_t heights = 0;
  std::string firstHeight;
};

inline constexpr size_t kMaxGazetteerBytes = size_t{512} << 20;
inline constexpr size_t kMaxNameBytes = 120;

// By what it looks like: '{' begins GeoJSON; a line with GeoNames' 19 columns between tabs, GeoNames; two angles as
// degrees:minutes:seconds, Alpano's table; else CSV.
Result<std::vector<Summit>> parseGazetteer(std::string_view text, GazetteerDoubts& doubts);
// A header with name, lat and lon (or latitude, longitude), perhaps height (height_m, ele, elevation, alt), in any
// order; commas or semicolons between; cells may stand in double quotes. Heights as heightFrom reads them.
Result<std::vector<Summit>> parseCsvGazetteer(std::string_view text);
// Points of a FeatureCollection; properties name and perhaps ele, height or elevation, numbers or text. Without a name:
// left out.
Result<std::vector<Summit>> parseGeoJsonGazetteer(std::string_view text, GazetteerDoubts& doubts);
// The dump of geonames.org; of class T the peaks, mountains, hills and volcanoes.
Result<std::vector<Summit>> parseGeoNamesGazetteer(std::string_view text);
// "  7:25:12 45:08:25  1325  R0 E07 BA MONTE CURT": longitude, latitude, height, three words, the name.
Result<std::vector<Summit>> parseAlpanoGazetteer(std::string_view text);

Result<std::vector<Summit>> loadGazetteer(const std::string& path);
Result<std::vector<Summit>> loadGazetteers(const std::vector<std::string>& paths);  // behind one another

}  // namespace eye
