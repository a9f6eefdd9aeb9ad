// Frames of reference and the named transforms between them, all in double.
//   ecef  metres, WGS84, x through (0 N, 0 E), z through the north pole
//   enu   metres, x east, y north, z along the ellipsoid's normal, at a geodetic point
//   body  x forward, y right, z down (aircraft)
//   eye   x right, y down, z forward (the view; y points down so that clip space needs no flip in Vulkan)
// A matrix `aFromB` takes coordinates in b to coordinates in a, so chains read right to left.
#pragma once

#include <glm/glm.hpp>

#include "geo/pose.h"

namespace eye {

using Vec3d = glm::dvec3;
using Mat3d = glm::dmat3;

// WGS84.
inline constexpr double kSemiMajorM = 6378137.0;
inline constexpr double kFlattening = 1.0 / 298.257223563;
inline constexpr double kSemiMinorM = kSemiMajorM * (1.0 - kFlattening);
inline constexpr double kMeanEarthRadiusM = 6371000.0;  // where a sphere will do

inline constexpr double radFromDeg(double deg) {
  return deg * 0.017453292519943295;
}
inline constexpr double degFromRad(double rad) {
  return rad * 57.29577951308232;
}

// Exact at the poles and the date line: -180 and 180 degrees give the same point, bit for bit.
Vec3d ecefFromGeodetic(const Geodetic& g);
// Latitude in [-90, 90], longitude in [-180, 180].
Geodetic geodeticFromEcef(const Vec3d& ecefM);

// Unit vector of the ellipsoid's outward normal, ecef.
Vec3d upAt(double latDeg, double lonDeg);
// Columns are east, north, up.
Mat3d ecefFromEnu(double latDeg, double lonDeg);
Mat3d enuFromBody(double headingDeg, double pitchDeg, double rollDeg);
// Body to eye only renames axes: forward = z, right = x, down = y.
Mat3d bodyFromEye();
Mat3d ecefFromEye(const Pose& pose);

}  // namespace eye
