// Which sides of the drawn chunks hang skirts, and how deep. Owner thread: render.
#pragma once

#include <span>

#include "paging/lod_select.h"

namespace eye {

// How far from a chunk's edge its skirt's lower rim may lie, in units of the greater of the two errors that it covers:
// 1.1 (own + neighbour's) down, and outwards by up to half of that.
inline constexpr double kSkirtMargin = 1.1;
inline constexpr double kSkirtReach = 2.5;

// Neighbours drawn at one level share their edge bit for bit and need none, nor does a side across which everything is
// outside the frustum (the walk culls nothing whose gap could be seen).
void assignSkirts(const TerrainCache& cache, std::span<DrawnChunk> draws);

}  // namespace eye
