// The parts of a view's frustum that a host has said; the others stay the channel's own.
#pragma once

#include <optional>

#include "geo/view.h"

namespace eye {

struct ViewEdges {
  std::optional<double> leftDeg, rightDeg, bottomDeg, topDeg;  // signed half-angles within 89.9
  std::optional<double> nearM;
  bool mirrorsAcross = false, mirrorsUpright = false;  // the picture as in a mirror: left for right, up for down
  bool operator==(const ViewEdges&) const = default;
};

// `own` with what the host has said. Where that leaves no picture, right of left or above bottom, `own` stays in that
// direction.
Frustum frustumWith(const Frustum& own, const ViewEdges& edges);

// The frustum with its edges exchanged as the host wants them mirrored, whoever has said where they are.
Frustum mirrored(const Frustum& frustum, const ViewEdges& edges);

}  // namespace eye
