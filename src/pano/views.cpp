#include "pano/views.h"

#include <algorithm>
#include <cmath>

namespace eye {
namespace {

// Pixels of a view per pixel of the panorama, each way: at a silhouette the nearest one is taken, a third of the
// panorama's pixel off at most.
constexpr double kOversampling = 1.5;
constexpr double kMarginPx = 4;  // on every side, for samples between the last pixels
constexpr double kHighestGroundM = 8850;
// The sphere's stretch turns azimuths by a thousandth of a radian.
constexpr double kTurnMargin = 0.003;

// By how much refraction raises, at most, what can be seen: the farthest ground's lift over its distance.
double refractionRad(const SceneBend& bend, double eyeHeightM) {
  const double liftPerM = std::max(bend.liftEastPerM, bend.liftNorthPerM);
  // 2 R / (1 - k), with the two halves of the way from the horizon to the eye and to the highest ground.
  const double curve = std::max(1e-9, 1 / (2 * kMeanEarthRadiusM) - liftPerM);
  const double farthestM = (std::sqrt(std::max(eyeHeightM, 0.0)) + std::sqrt(kHighestGroundM)) / std::sqrt(curve);
  return std::max(liftPerM, 0.0) * std::min(farthestM, kMeanEarthRadiusM);
}

}  // namespace

View panoramaView(const PanoramaFrame& frame, const Geodetic& eye, const SceneBend& bend, int index) {
  const double pixel = radFromDeg(frame.degPerPx()) / kOversampling;  // tangent a pixel
  const double halfRad = radFromDeg(kViewDeg / 2);
  const double margin = kMarginPx * pixel + kTurnMargin;
  const int halfWidthPx = static_cast<int>(std::ceil((std::tan(halfRad) + margin) / pixel));
  // In the view's corners an elevation angle lies farthest from the middle.
  const double highest = std::tan(radFromDeg(frame.elevationDeg(0))) / std::cos(halfRad);
  const double lift = refractionRad(bend, eye.altM) * (1 + highest * highest);
  const int abovePx = static_cast<int>(std::ceil((highest + margin) / pixel));
  const int belowPx = static_cast<int>(std::ceil((highest + margin + lift) / pixel));
  Frustum frustum;
  frustum.tanLeft = -halfWidthPx * pixel;
  frustum.tanRight = halfWidthPx * pixel;
  frustum.tanTop = abovePx * pixel;
  frustum.tanBottom = -belowPx * pixel;
  frustum.nearM = 0.5;  // an eye at a man's height sees the ground from 1 m on, even 60 degrees down
  return makeView({eye, viewHeadingDeg(index), 0, 0}, frustum, 2 * halfWidthPx, abovePx + belowPx);
}

}  // namespace eye
