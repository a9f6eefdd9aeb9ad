// Ways of cutting a mesh into clusters that the bake does not use, for comparison with groupByPlace.
#pragma once

#include "terrain/clusters.h"

namespace eye {

// meshoptimizer's greedy meshlets, which grow by neighbours that add few vertices and turn little. `mostTriangles`: a
// multiple of 4, 512 at most.
TriangleGroups groupByMeshlets(const ChunkMesh& mesh, uint32_t mostTriangles, float coneWeight);

// First by where triangles face: nearly level ones together, the others in `sectors` of equal width about the vertical;
// then each sector in compact patches.
TriangleGroups groupByAspect(const std::vector<TriangleShape>& triangles, uint32_t mostTriangles, int sectors);

// Halved like groupByPlace, but across the longest of six extents: the place's in half widths of the chunk, and the
// normal's times `facingWeight`.
TriangleGroups groupByPlaceAndFacing(const std::vector<TriangleShape>& triangles, uint32_t mostTriangles,
                                     double facingWeight);

}  // namespace eye
