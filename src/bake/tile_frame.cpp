#include "bake/tile_frame.h"

#include <algorithm>
#include <cmath>

namespace eye {
namespace {

constexpr double kEccentricitySquared = kFlattening * (2.0 - kFlattening);

}  // namespace

double primeVerticalRadiusM(double sinLat) {
  return kSemiMajorM / std::sqrt(1.0 - kEccentricitySquared * sinLat * sinLat);
}

double meridianRadiusM(double sinLat) {
  const double w2 = 1.0 - kEccentricitySquared * sinLat * sinLat;
  return kSemiMajorM * (1.0 - kEccentricitySquared) / (w2 * std::sqrt(w2));
}

Parallel parallelAt(double latDeg) {
  const double sinLat = std::sin(radFromDeg(latDeg));
  return Parallel{sinLat, std::cos(radFromDeg(latDeg)), primeVerticalRadiusM(sinLat)};
}

Meridian meridianAt(double lonDeg) {
  return Meridian{std::sin(radFromDeg(lonDeg)), std::cos(radFromDeg(lonDeg))};
}

Vec3d ecefFromGraticule(const Parallel& parallel, const Meridian& meridian, double heightM) {
  const double axisDistanceM = (parallel.primeVerticalM + heightM) * parallel.cosLat;
  return Vec3d(axisDistanceM * meridian.cosLon, axisDistanceM * meridian.sinLon,
               (parallel.primeVerticalM * (1.0 - kEccentricitySquared) + heightM) * parallel.sinLat);
}

TileFrame makeTileFrame(const TileKey& key) {
  const TileBounds bounds = key.bounds();
  const LatLon centre = latLonFromParam(key, TileParam{0.5, 0.5});
  const Parallel parallel = parallelAt(centre.latDeg);
  TileFrame frame;
  frame.ecefFromEnu = ecefFromEnu(centre.latDeg, centre.lonDeg);
  frame.depthM = parallel.primeVerticalM;  // the normal's length down to the axis
  frame.projectionCentreEcefM = Vec3d(0.0, 0.0, -kEccentricitySquared * parallel.primeVerticalM * parallel.sinLat);

  // Rays and normals part most at the tile's southern or northern end.
  double deflectionRad = 0;
  for (const double latDeg : {bounds.southDeg, bounds.northDeg}) {
    const Parallel p = parallelAt(latDeg);
    const Vec3d position = ecefFromGraticule(p, Meridian{0.0, 1.0}, 0.0) - frame.projectionCentreEcefM;
    const Vec3d up(p.cosLat, 0.0, p.sinLat);
    deflectionRad = std::max(deflectionRad, glm::length(glm::cross(glm::normalize(position), up)));
  }
  // On a slope of 8 : 1 a ray that leans by d is longer or shorter than the normal by 8 d.
  frame.inflation = 1.0 + 8.0 * deflectionRad;
  return frame;
}

PlanePoint planeFromEcef(const TileFrame& frame, const Vec3d& ecefM) {
  const Vec3d ray = ecefM - frame.projectionCentreEcefM;
  const double depthM = glm::dot(frame.ecefFromEnu[2], ray);
  const double scale = frame.depthM / depthM;
  return PlanePoint{glm::dot(frame.ecefFromEnu[0], ray) * scale, glm::dot(frame.ecefFromEnu[1], ray) * scale,
                    frame.depthM * (1.0 - scale)};
}

double metresPerZ(const TileFrame& frame, const PlanePoint& p) {
  const double depthRatio = 1.0 / (1.0 - p.z / frame.depthM);
  const double x = p.x / frame.depthM, y = p.y / frame.depthM;
  return depthRatio * depthRatio * std::sqrt(1.0 + x * x + y * y);
}

}  // namespace eye
