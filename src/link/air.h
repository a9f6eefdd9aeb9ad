// What the air lets see: the visibility of the whole, and of layers of fog and cloud.
#pragma once

#include <array>
#include <optional>

#include "geo/cloud_layer.h"

namespace eye {

struct AirLayer {
  double visibilityM = 0;  // 0: the layer does not change it
  double bottomM = 0, topM = 0;
  // Over these heights below and above it thins out.
  double bottomTransitionM = 0, topTransitionM = 0;
};

struct Air {
  std::optional<double> visibilityM;
  std::array<AirLayer, 10> layers;
  CloudLayers clouds;  // as they are seen from outside
};

// Where nothing is told.
inline constexpr double kClearVisibilityM = 60'000;

// Meteorological visibility around an eye at this altitude; nothing where nothing is told. Within the limits of
// pose_limits.h.
std::optional<double> visibilityAt(const Air& air, double altM);

}  // namespace eye
