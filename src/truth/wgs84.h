// Geodesy of the truth tests: WGS84 written a second time, from the textbook, so that an error in the program's own
// transforms shows as a difference. Doubles, degrees at the edge, metres, ecef.
#pragma once

namespace eye::truth {

struct Vec {
  double x = 0, y = 0, z = 0;
};
inline Vec operator+(Vec a, Vec b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vec operator-(Vec a, Vec b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vec operator*(double s, Vec a) {
  return {s * a.x, s * a.y, s * a.z};
}
inline double dot(Vec a, Vec b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
double length(Vec a);

struct Place {
  double latDeg = 0, lonDeg = 0, altM = 0;
};

struct EyePose {
  Place at;
  double headingDeg = 0, pitchDeg = 0, rollDeg = 0;
};

// A point with what a march along a ray needs beside its place: the local axes and the radii of curvature.
struct LocalFrame {
  Place place;
  Vec east, north, up;
  double metresPerDegLat = 0, metresPerDegLon = 0;  // at the point's own height
};

Vec ecefFromPlace(const Place& place);
// Bowring's formula, applied twice: below 1e-6 m from 10 km under the ellipsoid to 1,000 km above it.
LocalFrame frameAt(Vec ecefM);

// The view's axes in ecef: yaw, then pitch, then roll, from the aircraft's level attitude.
struct EyeAxes {
  Vec forward, right, up;
};
EyeAxes axesOf(const EyePose& pose);

}  // namespace eye::truth
