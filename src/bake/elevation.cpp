#include "bake/elevation.h"

namespace eye {

void ElevationSurface::heightsM(const std::vector<LatLon>& points, std::vector<double>& heightsM) const {
  heightsM.resize(points.size());
  for (size_t i = 0; i < points.size(); ++i) heightsM[i] = heightM(points[i].latDeg, points[i].lonDeg);
}

std::vector<double> ElevationSurface::spacingsDeg(const TileBounds& region) const {
  const double finestDeg = finestSpacingDeg(region);
  return finestDeg > 0 ? std::vector{finestDeg} : std::vector<double>{};
}

}  // namespace eye
