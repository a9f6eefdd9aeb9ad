// Layers of cloud over the whole Earth, as a host tells of them and the renderer draws them.
#pragma once

#include <array>

namespace eye {

struct CloudLayer {
  double baseM = 0, topM = 0;  // heights above the ellipsoid
  // Over these heights below the base and above the top it thins out.
  double baseTransitionM = 0, topTransitionM = 0;
  double coverage = 0;  // of the sky, 0 to 1; 0: there is no layer
  bool operator==(const CloudLayer&) const = default;
};

using CloudLayers = std::array<CloudLayer, 3>;

}  // namespace eye
