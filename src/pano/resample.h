// From a view's pixels to the panorama's: columns of one azimuth, rows of one elevation angle, distances along the ray.
#pragma once

#include <span>

#include "geo/scene_bend.h"
#include "geo/view.h"
#include "pano/panorama.h"

namespace eye {

// What is told of a pixel: metres along its ray, or beside them the depth as paper 002 takes it back from the depth
// buffer (see planar_depth.h).
enum class DepthKind { range, paper };

// Fills the columns of view `index` (see views.h). `rgba` and `depth` are the view's: reversed-Z, 0 where nothing is.
// Where four neighbours belong together, 1 / z is interpolated between them, which is exact on a plane; at a
// silhouette the nearest counts. The paper's depth where the panorama has room for it. Uses every core.
void resample(const View& view, int index, std::span<const uint8_t> rgba, std::span<const float> depth,
              const SceneBend& bend, Panorama& panorama);

}  // namespace eye
