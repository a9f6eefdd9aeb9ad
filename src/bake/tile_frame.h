// A tile's plane: a central projection that takes straight lines in space to straight lines, so that a triangulation of
// the plane is one of the mesh, exactly, however high its vertices and however large the tile.
//
// The centre of projection lies on the Earth's axis where the ellipsoid's normal at the tile's centre meets it: rays
// are then normals, to the fraction that `inflation` covers. The third coordinate, z = r0 * (1 - r0 / depth), is chosen
// so that a plane in space is a linear function z(x, y): the mesh is a height field, and its error a difference in z.
#pragma once

#include "geo/frames.h"
#include "terrain/tile_key.h"

namespace eye {

// Metres near the tile's centre: x east, y north, z about the height above the tangent plane.
struct PlanePoint {
  double x = 0, y = 0, z = 0;
};

struct TileFrame {
  Vec3d projectionCentreEcefM{};
  Mat3d ecefFromEnu{1.0};
  double depthM = 1;  // r0: from the centre of projection to the ellipsoid at the tile's centre
  // A distance along the ray times this is no less than that along the normal, on slopes up to 8 : 1.
  double inflation = 1;
};

TileFrame makeTileFrame(const TileKey& key);

PlanePoint planeFromEcef(const TileFrame& frame, const Vec3d& ecefM);
// Metres along the normal for a unit of z at a point.
double metresPerZ(const TileFrame& frame, const PlanePoint& p);

// A circle of latitude: what all points on it share, so that a grid of positions costs no sines.
struct Parallel {
  double sinLat, cosLat, primeVerticalM;
};
struct Meridian {
  double sinLon, cosLon;
};
Parallel parallelAt(double latDeg);
Meridian meridianAt(double lonDeg);
Vec3d ecefFromGraticule(const Parallel& parallel, const Meridian& meridian, double heightM);

// Radii of curvature of the ellipsoid along a meridian and across it.
double meridianRadiusM(double sinLat);
double primeVerticalRadiusM(double sinLat);

}  // namespace eye
