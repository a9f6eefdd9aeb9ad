// How far things reach.
#pragma once

#include "terrain/chunk.h"

namespace eye {

// 0 inside.
double distanceToBox(const Vec3d& pointEcefM, const OrientedBox& box);

// Of the mesh's triangles, metres.
float longestEdgeM(const ChunkMesh& mesh, double stepM);

}  // namespace eye
