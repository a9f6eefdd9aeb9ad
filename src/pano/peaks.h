// Summits in a panorama: where they are drawn, whether they show, and how far the map says that they are.
#pragma once

#include <optional>
#include <span>

#include "base/error.h"
#include "paging/ground_query.h"
#include "pano/gazetteer.h"
#include "pano/panorama.h"
#include "pano/render_panorama.h"

namespace eye {

struct PanoramaPeak {
  std::string name;
  Geodetic summit;                          // the gazetteer's; its height the terrain's where the gazetteer has none
  Geodetic ground{};                        // the highest ground within reach of it: what the picture shows of it
  double azimuthDeg = 0, elevationDeg = 0;  // of the summit, as it appears: with refraction
  double trueM = 0;                         // eye to summit, straight
  double x = 0, y = 0;                      // of the ground's summit in the picture, pixels
  double groundM = 0;                       // eye to the ground's summit, straight
  bool visible = false;                     // by line of sight, and the map has it
  double measuredM = 0;                     // in the map, at the ground's summit; where visible
};

// A gazetteer's position may be off, and elevation on a raster cuts summits off: how far the highest ground is looked
// for around it, metres. Two posts of 3 arc-seconds, and a gazetteer's fourth decimal.
inline constexpr double kSummitReachM = 250;

// The highest ground that is reached uphill, in steps from 60 m down to 4 m.
Result<Geodetic> climb(GroundQuery& ground, const Geodetic& from, double reachM);

// Those that could be seen, by distance and height, the nearest first. Opens the options' terrain; uses every core.
Result<std::vector<PanoramaPeak>> findPeaks(const Panorama& panorama, const PanoramaOptions& options,
                                            std::span<const Summit> summits);

// Where a point is drawn, in degrees; z: the straight distance, metres.
struct Sighting {
  double azimuthDeg = 0, elevationDeg = 0, distanceM = 0;
};
Sighting sightingOf(const Geodetic& eye, const Geodetic& point, const SceneBend& bend, EarthShape earth);

// The map's pixel that shows a summit which is drawn at (x, y) and `summitM` away: the one that holds the place or,
// where that is sky or ground behind, one of the two under it. Nothing where none is about as far as the summit's own
// slope.
std::optional<size_t> summitPixel(const Panorama& panorama, double x, double y, double summitM);

// BASE.peaks.csv. docs/PANORAMA.md has the columns.
Result<void> writePeaks(const std::string& path, std::span<const PanoramaPeak> peaks);

}  // namespace eye
