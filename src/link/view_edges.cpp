#include "link/view_edges.h"

#include <cmath>
#include <utility>

namespace eye {

Frustum frustumWith(const Frustum& own, const ViewEdges& edges) {
  const auto tangent = [](const std::optional<double>& deg, double otherwise) {
    return deg ? std::tan(radFromDeg(*deg)) : otherwise;
  };
  constexpr double kNarrowest = 1e-6;  // a millionth of a radian: less is no picture, and zoom without end
  Frustum frustum = own;
  const double left = tangent(edges.leftDeg, own.tanLeft), right = tangent(edges.rightDeg, own.tanRight);
  if (right - left >= kNarrowest) frustum.tanLeft = left, frustum.tanRight = right;
  const double bottom = tangent(edges.bottomDeg, own.tanBottom), top = tangent(edges.topDeg, own.tanTop);
  if (top - bottom >= kNarrowest) frustum.tanBottom = bottom, frustum.tanTop = top;
  if (edges.nearM) frustum.nearM = *edges.nearM;
  return frustum;
}

Frustum mirrored(const Frustum& frustum, const ViewEdges& edges) {
  Frustum result = frustum;
  if (edges.mirrorsAcross) std::swap(result.tanLeft, result.tanRight);
  if (edges.mirrorsUpright) std::swap(result.tanBottom, result.tanTop);
  return result;
}

}  // namespace eye
