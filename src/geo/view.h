// The view: where the eye is, how it is turned and what its (perhaps asymmetric) frustum is.
#pragma once

#include <array>

#include "base/error.h"
#include "geo/frames.h"

namespace eye {

// Tangents of the signed half-angles: left and bottom are negative in a symmetric frustum. Pixels are square. In a view
// as in a mirror left is the greater one, upside down bottom is.
struct Frustum {
  double tanLeft = -1, tanRight = 1, tanBottom = -0.75, tanTop = 0.75;
  double nearM = 1;  // depth = nearM / z (reversed-Z, infinite far plane); the precision does not depend on it
  bool operator==(const Frustum&) const = default;
};

// `fovDeg`: the full horizontal angle, (0, 179]. Vertical extent follows from the size.
Frustum symmetricFrustum(double fovDeg, int widthPx, int heightPx, double nearM);
// Signed half-angles in degrees, each in (-89.9, 89.9), left < right, bottom < top (CIGI View Definition).
Frustum offAxisFrustum(double leftDeg, double rightDeg, double bottomDeg, double topDeg, double nearM);

struct View {
  Vec3d eyeEcefM{};
  Mat3d eyeFromEcef{1.0};  // rotation only
  Frustum frustum;
  int widthPx = 800, heightPx = 600;
};

View makeView(const Pose& pose, const Frustum& frustum, int widthPx, int heightPx);

// Pixels that one metre covers at one metre's distance, on the view's axis: screen-space error = error * this /
// distance.
double pixelsPerRadian(const View& view);

// The direction (eye frame, z = 1) of the ray through the centre of pixel (column, row); row 0 is the top.
Vec3d rayThroughPixel(const Frustum& frustum, int widthPx, int heightPx, int column, int row);

// Inward unit normals (ecef) of the five planes left, right, bottom, top, near. A point p (relative to the eye) is
// inside when dot(n, p) >= d; d is 0 but for the near plane.
struct FrustumPlanes {
  std::array<Vec3d, 5> normalsEcef;
  std::array<double, 5> offsetsM;
};
FrustumPlanes frustumPlanes(const View& view);

}  // namespace eye
