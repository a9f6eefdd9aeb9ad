// The parameters (s, t) of a cell, see tile_key.h.
#include <cmath>

#include <GeographicLib/Math.hpp>

#include "terrain/tile_key.h"

namespace eye {

LatLon latLonFromParam(const TileKey& key, TileParam p) {
  const TileBounds b = key.bounds();
  const double heightDeg = b.northDeg - b.southDeg, widthDeg = b.eastDeg - b.westDeg;  // exact, as are all bounds
  if (!key.isPolar()) return LatLon{b.southDeg + p.t * heightDeg, b.westDeg + p.s * widthDeg};
  // A pole cell's column is a whole octant, so its azimuth is the longitude from its west edge. In degrees the edges
  // (s = 0, t = 0) come out exact.
  const double rho = std::hypot(p.s, p.t);
  const double azimuthDeg =
      key.isSouthern() ? GeographicLib::Math::atan2d(p.s, p.t) : GeographicLib::Math::atan2d(p.t, p.s);
  return LatLon{key.isSouthern() ? b.southDeg + rho * heightDeg : b.northDeg - rho * heightDeg, b.westDeg + azimuthDeg};
}

TileParam paramFromLatLon(const TileKey& key, LatLon p) {
  const TileBounds b = key.bounds();
  const double centreLonDeg = (b.westDeg + b.eastDeg) / 2.0;
  const double lonDeg = p.lonDeg - 360.0 * std::round((p.lonDeg - centreLonDeg) / 360.0);
  const double heightDeg = b.northDeg - b.southDeg, widthDeg = b.eastDeg - b.westDeg;
  if (!key.isPolar()) return TileParam{(lonDeg - b.westDeg) / widthDeg, (p.latDeg - b.southDeg) / heightDeg};
  const double rho = (90.0 - std::abs(p.latDeg)) / heightDeg;
  double sinAzimuth = 0, cosAzimuth = 0;
  GeographicLib::Math::sincosd(lonDeg - b.westDeg, sinAzimuth, cosAzimuth);
  const double alongWest = rho * cosAzimuth, alongEast = rho * sinAzimuth;
  return key.isSouthern() ? TileParam{alongEast, alongWest} : TileParam{alongWest, alongEast};
}

}  // namespace eye
