// How far the surface departs from a straight edge of a mesh.
#pragma once

#include "bake/sample_grid.h"

namespace eye {

// A vertex of the mesh where it really is, rounding included.
struct ChordEnd {
  double latDeg = 0, lonDeg = 0, altM = 0;
};

struct ChordError {
  double errorM = 0;   // along the normal, unsigned
  LatLon place{};      // where
  double heightM = 0;  // of the surface there
};

// The greatest departure over the part of the segment that lies in the grid: at its ends, where it crosses lines of the
// grid, and at the extrema between, where the departure is a parabola. Keeps the greater of it and `worst`.
// Segments too long for a parabola to describe within `toleranceM` / 1000 are cut.
void findChordError(const SampleGrid& grid, const ChordEnd& a, const ChordEnd& b, double toleranceM, ChordError& worst);

}  // namespace eye
