// The eight level views that a panorama is made of, 45 degrees each and a little more, at 22.5, 67.5 ... degrees
// (paper 002).
#pragma once

#include "geo/scene_bend.h"
#include "geo/view.h"
#include "pano/panorama.h"

namespace eye {

inline constexpr int kViews = 8;
inline constexpr double kViewDeg = 360.0 / kViews;

inline double viewHeadingDeg(int index) {
  return (index + 0.5) * kViewDeg;
}

// All have the same frustum and size. Its pixels are finer than the panorama's everywhere. It reaches lower than the
// panorama by what refraction lifts, because chunks are selected where they are, not where they are seen.
View panoramaView(const PanoramaFrame& frame, const Geodetic& eye, const SceneBend& bend, int index);

}  // namespace eye
