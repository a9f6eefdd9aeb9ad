// eyepoint-panorama from its options to its files.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "paging/ground_query.h"
#include "pano/gazetteer.h"
#include "pano/render_panorama.h"

namespace eye {

// Where --at wants the eye. Without altM and aboveGroundM: a person's height above the ground.
struct EyeWish {
  double latDeg = 0, lonDeg = 0;
  std::optional<double> altM, aboveGroundM;
  bool onSummit = false;  // the highest ground uphill within kSummitReachM instead of the place itself
};

// "lat,lon", "lat,lon,alt" or "lat,lon,+height above the ground".
Result<EyeWish> parseEyeWish(const std::string& text);

struct PanoramaJob {
  PanoramaOptions options;  // but for the eye
  EyeWish at;
  std::vector<std::string> peaks;  // gazetteers
  std::string out;                 // the outputs' names without their endings
};

// The eye above the ground of the terrain; under it: an error that says how high the ground is.
Result<Geodetic> placeEye(const EyeWish& wish, GroundQuery& ground);
// Where the eye stands, with the nearest summit's name if it stands on one.
std::string titleOf(const Geodetic& eye, std::span<const Summit> summits);

Result<void> runPanorama(const PanoramaJob& job);

}  // namespace eye
