// The true distance of every pixel of a view, for judging what was drawn: of rays cast in doubles on the elevation that
// a database was baked from, or, where that is not at hand, of the database's own finest meshes drawn in doubles.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "geo/pose.h"
#include "geo/view.h"
#include "terrain/database.h"
#include "truth/truth_metric.h"

namespace eye {

class TrueDistances {
 public:
  virtual ~TrueDistances() = default;
  virtual std::string description() const = 0;
  // Level or turned, symmetric, `fovDeg` wide.
  virtual Result<truth::TruthImage> image(const Pose& pose, double fovDeg, int widthPx, int heightPx) = 0;
};

// `elevation`: sources as eyepoint-bake takes them, in order of preference; none: the meshes. `around`: places near
// which views will be. An error where a source cannot be read or does not reach a place.
Result<std::unique_ptr<TrueDistances>> openTrueDistances(const DatabaseReader& reader,
                                                         const std::vector<std::string>& elevation,
                                                         const std::vector<LatLon>& around);

// How many pixels the drawn skyline lies above or below the true one: the mean over the columns in which either has a
// pixel of sky above terrain. `renderedM`: NaN where sky is drawn.
double skylineErrorPx(const truth::TruthImage& truth, std::span<const float> renderedM);

}  // namespace eye
