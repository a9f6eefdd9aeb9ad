#include "link/air.h"

#include <algorithm>

#include "link/pose_limits.h"

namespace eye {
namespace {

// 1 inside a layer, 0 beyond its transitions.
double shareOf(const AirLayer& layer, double altM) {
  if (altM < layer.bottomM) {
    const double belowM = layer.bottomM - altM;
    return belowM < layer.bottomTransitionM ? 1 - belowM / layer.bottomTransitionM : 0;
  }
  if (altM > layer.topM) {
    const double aboveM = altM - layer.topM;
    return aboveM < layer.topTransitionM ? 1 - aboveM / layer.topTransitionM : 0;
  }
  return 1;
}

}  // namespace

// What adds up along a ray is the inverse of visibility, the extinction: transitions are linear in it, and the thickest
// of all counts.
std::optional<double> visibilityAt(const Air& air, double altM) {
  const double clear = 1 / std::max(air.visibilityM.value_or(kClearVisibilityM), kMinVisibilityM);
  double thickest = clear;
  bool any = air.visibilityM.has_value();
  for (const AirLayer& layer : air.layers) {
    if (layer.visibilityM <= 0) continue;
    any = true;
    const double inside = 1 / std::max(layer.visibilityM, kMinVisibilityM);
    thickest = std::max(thickest, clear + (inside - clear) * shareOf(layer, altM));
  }
  if (!any) return std::nullopt;
  return std::clamp(1 / thickest, kMinVisibilityM, kMaxVisibilityM);
}

}  // namespace eye
