#include "geo/view.h"

#include <algorithm>
#include <cmath>

namespace eye {

Frustum symmetricFrustum(double fovDeg, int widthPx, int heightPx, double nearM) {
  EYE_CHECK(fovDeg > 0.0 && fovDeg <= 179.0 && widthPx > 0 && heightPx > 0 && nearM > 0.0);
  const double tanRight = std::tan(radFromDeg(fovDeg) / 2.0);
  const double tanTop = tanRight * heightPx / widthPx;
  return Frustum{-tanRight, tanRight, -tanTop, tanTop, nearM};
}

Frustum offAxisFrustum(double leftDeg, double rightDeg, double bottomDeg, double topDeg, double nearM) {
  EYE_CHECK(leftDeg > -89.9 && leftDeg < rightDeg && rightDeg < 89.9);
  EYE_CHECK(bottomDeg > -89.9 && bottomDeg < topDeg && topDeg < 89.9 && nearM > 0.0);
  const auto tanDeg = [](double deg) { return std::tan(radFromDeg(deg)); };
  return Frustum{tanDeg(leftDeg), tanDeg(rightDeg), tanDeg(bottomDeg), tanDeg(topDeg), nearM};
}

View makeView(const Pose& pose, const Frustum& frustum, int widthPx, int heightPx) {
  return View{ecefFromGeodetic(pose.position), glm::transpose(ecefFromEye(pose)), frustum, widthPx, heightPx};
}

double pixelsPerRadian(const View& view) {
  // The two agree for square pixels; the finer one holds where a host asks for a frustum of another shape.
  const Frustum& f = view.frustum;
  return std::max(view.widthPx / std::abs(f.tanRight - f.tanLeft), view.heightPx / std::abs(f.tanTop - f.tanBottom));
}

Vec3d rayThroughPixel(const Frustum& frustum, int widthPx, int heightPx, int column, int row) {
  const double acrossFromLeft = (column + 0.5) / widthPx, downFromTop = (row + 0.5) / heightPx;
  const double tanRightwards = frustum.tanLeft + acrossFromLeft * (frustum.tanRight - frustum.tanLeft);
  const double tanUpwards = frustum.tanTop + downFromTop * (frustum.tanBottom - frustum.tanTop);
  return Vec3d(tanRightwards, -tanUpwards, 1.0);  // the eye's y points down
}

FrustumPlanes frustumPlanes(const View& view) {
  const Frustum& f = view.frustum;
  const auto [left, right] = std::minmax(f.tanLeft, f.tanRight);
  const auto [bottom, top] = std::minmax(f.tanBottom, f.tanTop);
  const std::array<Vec3d, 5> normalsEye{Vec3d(1, 0, -left), Vec3d(-1, 0, right), Vec3d(0, -1, -bottom),
                                        Vec3d(0, 1, top), Vec3d(0, 0, 1)};
  const Mat3d ecefFromEyeAxes = glm::transpose(view.eyeFromEcef);
  FrustumPlanes planes{};
  for (size_t i = 0; i < normalsEye.size(); ++i)
    planes.normalsEcef[i] = ecefFromEyeAxes * glm::normalize(normalsEye[i]);
  planes.offsetsM[4] = f.nearM;
  return planes;
}

}  // namespace eye
