#include "geo/scene_bend.h"

#include <cmath>

namespace eye {

SceneBend sceneBend(double latDeg, double refraction, EarthShape shape) {
  SceneBend bend;
  if (shape == EarthShape::ellipsoid) {
    bend.refractEastPerM = bend.refractNorthPerM = refraction / (2 * kMeanEarthRadiusM);
    bend.liftEastPerM = bend.liftNorthPerM = bend.refractEastPerM;
    return bend;
  }
  // Radii of curvature: of the prime vertical and of the meridian.
  constexpr double kEccentricitySquared = kFlattening * (2 - kFlattening);
  const double sinLat = std::sin(radFromDeg(latDeg)), w = 1 - kEccentricitySquared * sinLat * sinLat;
  const double eastRadiusM = kSemiMajorM / std::sqrt(w);
  const double northRadiusM = eastRadiusM * (1 - kEccentricitySquared) / w;
  const auto along = [&](double radiusM, double& stretch, double& liftPerM, double& refractPerM) {
    const double grown = kMeanEarthRadiusM / radiusM;
    stretch = grown - 1;
    refractPerM = refraction * grown * grown / (2 * kMeanEarthRadiusM);
    liftPerM = (1 / radiusM - grown * grown / kMeanEarthRadiusM) / 2 + refractPerM;
  };
  along(eastRadiusM, bend.stretchEast, bend.liftEastPerM, bend.refractEastPerM);
  along(northRadiusM, bend.stretchNorth, bend.liftNorthPerM, bend.refractNorthPerM);
  return bend;
}

Vec3d bentEnu(const SceneBend& bend, const Vec3d& o) {
  return {o.x * (1 + bend.stretchEast), o.y * (1 + bend.stretchNorth),
          o.z + bend.liftEastPerM * o.x * o.x + bend.liftNorthPerM * o.y * o.y};
}

Vec3d unrefractedEnu(const SceneBend& bend, const Vec3d& b) {
  const double east = b.x / (1 + bend.stretchEast), north = b.y / (1 + bend.stretchNorth);
  return {b.x, b.y, b.z - bend.refractEastPerM * east * east - bend.refractNorthPerM * north * north};
}

Vec3d offsetEnu(const Geodetic& eye, const Geodetic& point, EarthShape shape) {
  const auto place = [&](const Geodetic& g) {
    return shape == EarthShape::ellipsoid ? ecefFromGeodetic(g)
                                          : (kMeanEarthRadiusM + g.altM) * upAt(g.latDeg, g.lonDeg);
  };
  return glm::transpose(ecefFromEnu(eye.latDeg, eye.lonDeg)) * (place(point) - place(eye));
}

}  // namespace eye
