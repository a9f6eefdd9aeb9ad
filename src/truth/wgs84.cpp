#include "truth/wgs84.h"

#include <cmath>

namespace eye::truth {
namespace {

constexpr double kA = 6378137.0;            // semi-major axis, metres
constexpr double kF = 1 / 298.257223563;    // flattening
constexpr double kB = kA * (1 - kF);        // semi-minor axis
constexpr double kE2 = kF * (2 - kF);       // first eccentricity squared
constexpr double kEp2 = kE2 / (1 - kE2);    // second eccentricity squared
constexpr double kDeg = 57.29577951308232;  // degrees in a radian

// cos and sin of the angle whose tangent is s / c with c >= 0.
struct SinCos {
  double s, c;
};
SinCos direction(double s, double c) {
  const double norm = 1 / std::sqrt(s * s + c * c);
  return {s * norm, c * norm};
}

}  // namespace

double length(Vec a) {
  return std::sqrt(dot(a, a));
}

Vec ecefFromPlace(const Place& place) {
  const double lat = place.latDeg / kDeg, lon = place.lonDeg / kDeg;
  const double primeVertical = kA / std::sqrt(1 - kE2 * std::sin(lat) * std::sin(lat));
  const double fromAxis = (primeVertical + place.altM) * std::cos(lat);
  return {fromAxis * std::cos(lon), fromAxis * std::sin(lon), ((1 - kE2) * primeVertical + place.altM) * std::sin(lat)};
}

LocalFrame frameAt(Vec p) {
  const double fromAxis = std::hypot(p.x, p.y);
  SinCos reduced = direction(p.z * kA, fromAxis * kB);  // Bowring's parametric latitude
  SinCos lat{};
  for (int pass = 0; pass < 2; ++pass) {
    lat = direction(p.z + kEp2 * kB * reduced.s * reduced.s * reduced.s,
                    fromAxis - kE2 * kA * reduced.c * reduced.c * reduced.c);
    reduced = direction((1 - kF) * lat.s, lat.c);
  }
  const double w2 = 1 - kE2 * lat.s * lat.s, w = std::sqrt(w2);
  const double alt = fromAxis * lat.c + p.z * lat.s - kA * w;
  const double cosLon = fromAxis > 0 ? p.x / fromAxis : 1, sinLon = fromAxis > 0 ? p.y / fromAxis : 0;
  LocalFrame frame;
  frame.place = {kDeg * std::atan2(lat.s, lat.c), kDeg * std::atan2(sinLon, cosLon), alt};
  frame.east = {-sinLon, cosLon, 0};
  frame.north = {-lat.s * cosLon, -lat.s * sinLon, lat.c};
  frame.up = {lat.c * cosLon, lat.c * sinLon, lat.s};
  frame.metresPerDegLat = (kA * (1 - kE2) / (w2 * w) + alt) / kDeg;
  frame.metresPerDegLon = (kA / w + alt) * lat.c / kDeg;
  return frame;
}

EyeAxes axesOf(const EyePose& pose) {
  const LocalFrame local = frameAt(ecefFromPlace(pose.at));
  const double h = pose.headingDeg / kDeg, p = pose.pitchDeg / kDeg, r = pose.rollDeg / kDeg;
  const Vec level = std::sin(h) * local.east + std::cos(h) * local.north;  // the heading, horizontal
  const Vec right = std::cos(h) * local.east - std::sin(h) * local.north;
  const Vec forward = std::cos(p) * level + std::sin(p) * local.up;
  const Vec up = std::cos(p) * local.up - std::sin(p) * level;
  // Rolling right turns the right wing down and the head to the right.
  return {forward, std::cos(r) * right - std::sin(r) * up, std::cos(r) * up + std::sin(r) * right};
}

}  // namespace eye::truth
