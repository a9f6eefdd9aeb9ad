// The common edges of tiles: curves over a parallel or a meridian, simplified alike from both sides.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "bake/elevation.h"
#include "geo/frames.h"

namespace eye {

// Part of a parallel (west to east) or of a meridian (south to north): a side, or half a side where the columns double.
struct EdgeUnit {
  LatLon from, to;
};

struct EdgePoint {
  LatLon place;  // in the unit's own longitudes: -180 stays -180
  double heightM = 0;
  Vec3d ecefM{};
};

// Both ends and what is needed between them, in the unit's direction: a function of the arguments alone, the same to
// the bit for the units at longitudes 180 and -180. The straight segments deviate from the surface by at most half the
// tolerance, seen along the normal above the curve itself, and by a quarter of it horizontally.
// `stepM`: of the lattice that the points will be rounded to.
std::vector<EdgePoint> simplifyEdge(const ElevationSurface& surface, const EdgeUnit& unit, double toleranceM,
                                    double stepM);

// The loop around a cell, counterclockwise, as ChunkMesh has it.
struct TileBoundary {
  std::vector<EdgePoint> loop;
  std::array<uint16_t, 4> counts{};  // ChunkMesh::boundary
};
// What any tile of the level may be off by, metres.
using TileTolerance = std::function<double(const TileKey&)>;
TileBoundary makeBoundary(const ElevationSurface& surface, const TileKey& key, const TileTolerance& toleranceM,
                          double stepM);

}  // namespace eye
