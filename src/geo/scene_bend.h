// Light that bends in the air, and an Earth of another shape, as a scene that is bent about the eye before it is
// projected. Pure.
//
// In the eye's east, north, up frame a ray that leaves at elevation a is the parabola u = d tan(a) - k d^2 / (2 R) over
// the level distance d: an arc whose radius is R / k, which is what refraction with the coefficient k means. Lifting
// every point by k d^2 / (2 R) makes every such ray from the eye a straight line, so an ordinary projection of the
// lifted scene shows each point where the bent ray arrives from, and hides what the bent ray does not reach.
//
// A sphere instead of the ellipsoid is a stretch of the level offsets and another lift: the radii of curvature differ.
// Exact to the second order; at 100 km up to 8 m are left.
#pragma once

#include "geo/frames.h"

namespace eye {

enum class EarthShape { ellipsoid, sphere };

struct SceneBend {
  double stretchEast = 0, stretchNorth = 0;          // share by which level offsets grow
  double liftEastPerM = 0, liftNorthPerM = 0;        // upwards, times the square of the offset before it was stretched
  double refractEastPerM = 0, refractNorthPerM = 0;  // the part of the lift that is refraction, not the Earth's shape
  bool operator==(const SceneBend&) const = default;
};

// `refraction`: k, the Earth's radius over the ray's; 0.13 is the surveyors' mean by day.
SceneBend sceneBend(double latDeg, double refraction, EarthShape shape);

// From an offset in the eye's frame to where it is drawn.
Vec3d bentEnu(const SceneBend& bend, const Vec3d& offsetEnuM);
// From where it is drawn to the offset on the Earth of that shape, without refraction: its length is the distance.
Vec3d unrefractedEnu(const SceneBend& bend, const Vec3d& bentEnuM);
// What the eye's frame has for a point on an Earth of that shape, exactly: for truths.
Vec3d offsetEnu(const Geodetic& eye, const Geodetic& point, EarthShape shape);

}  // namespace eye
