// Posts of many files counted on one lattice of whole indices, so that neighbours' posts coincide exactly.
#pragma once

#include <cstdint>
#include <optional>

#include "raster/geo_raster.h"

namespace eye {

// Post k lies at originDeg + (k + phase) / perDegree.
struct PostAxis {
  double originDeg = 0;  // -90 for latitude, -180 for longitude
  double perDegree = 1;  // posts a degree; a whole number, exactly, for the usual spacings
  double phase = 0;      // [0, 1)
  double deg(int64_t k) const { return (static_cast<double>(k) + phase) / perDegree + originDeg; }
  double position(double deg) const { return (deg - originDeg) * perDegree - phase; }
};

struct PostLattice {
  PostAxis lat, lon;
  int64_t turn = 0;  // columns in 360 degrees, where that is whole: then column k + turn is column k; else 0
};

struct PostRect {
  int64_t south = 0, west = 0;  // index of the south-westernmost post
  int64_t rows = 0, columns = 0;
  int64_t north() const { return south + rows - 1; }
  int64_t east() const { return west + columns - 1; }
};

PostLattice latticeOf(const GeoGrid& grid);
// Where the grid's posts lie on the lattice; none if they do not coincide with its posts to a fiftieth of the spacing.
std::optional<PostRect> rectOn(const PostLattice& lattice, const GeoGrid& grid);
// The common part; rows or columns are 0 or less where there is none.
PostRect intersect(const PostRect& a, const PostRect& b);

}  // namespace eye
