#include "bake/surface_normal.h"

#include <algorithm>
#include <cmath>

#include "bake/tile_frame.h"

namespace eye {
namespace {

// Nearer to a pole than this, east and west of a place are found in space.
constexpr double kNearPoleDeg = 89.0;

LatLon wrapped(LatLon p) {
  p.lonDeg -= 360.0 * std::round(p.lonDeg / 360.0);
  return p;
}

LatLon placeOf(const Vec3d& ecefM) {
  const Geodetic g = geodeticFromEcef(ecefM);
  return LatLon{g.latDeg, g.lonDeg};
}

}  // namespace

void surfaceNormals(const ElevationSurface& surface, const std::vector<LatLon>& places, double reachM,
                    std::vector<Vec3d>& normals) {
  thread_local std::vector<LatLon> around;  // east, west, north, south of each
  thread_local std::vector<double> heightsM;
  around.clear();
  for (LatLon p : places) {
    if (std::abs(p.latDeg) > kNearPoleDeg) {
      if (std::abs(p.latDeg) == 90.0) p.lonDeg = 0.0;
      const Mat3d axes = ecefFromEnu(p.latDeg, p.lonDeg);
      const Vec3d at = ecefFromGeodetic({p.latDeg, p.lonDeg, 0.0});
      for (const Vec3d& aside : {axes[0], -axes[0], axes[1], -axes[1]}) around.push_back(placeOf(at + reachM * aside));
      continue;
    }
    if (p.lonDeg == -180.0) p.lonDeg = 180.0;
    const Parallel parallel = parallelAt(p.latDeg);
    const double dLat = degFromRad(reachM / meridianRadiusM(parallel.sinLat));
    const double dLon = degFromRad(reachM / (parallel.primeVerticalM * parallel.cosLat));
    around.push_back(wrapped({p.latDeg, p.lonDeg + dLon}));
    around.push_back(wrapped({p.latDeg, p.lonDeg - dLon}));
    around.push_back({std::min(p.latDeg + dLat, 90.0), p.lonDeg});
    around.push_back({std::max(p.latDeg - dLat, -90.0), p.lonDeg});
  }
  surface.heightsM(around, heightsM);
  normals.resize(places.size());
  for (size_t i = 0; i < places.size(); ++i) {
    LatLon p = places[i];
    if (std::abs(p.latDeg) == 90.0) p.lonDeg = 0.0;
    if (p.lonDeg == -180.0) p.lonDeg = 180.0;
    const double slopeEast = (heightsM[4 * i] - heightsM[4 * i + 1]) / (2.0 * reachM);
    const double slopeNorth = (heightsM[4 * i + 2] - heightsM[4 * i + 3]) / (2.0 * reachM);
    normals[i] = ecefFromEnu(p.latDeg, p.lonDeg) * glm::normalize(Vec3d(-slopeEast, -slopeNorth, 1.0));
  }
}

}  // namespace eye
