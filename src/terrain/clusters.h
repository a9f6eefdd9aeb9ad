// Clusters: a chunk's triangles in patches, each with a box and a cone that holds its normals, see ChunkCluster.
// docs/CULLING.md says how the patches were chosen.
#pragma once

#include <vector>

#include "terrain/chunk.h"

namespace eye {

// Where a mesh lies and what holds it.
struct MeshPlace {
  OrientedBox box;
  LatticePoint originLattice{};
  double stepM = 1;
};
inline MeshPlace placeOf(const ChunkMeta& meta) {
  return {meta.box, meta.originLattice, meta.stepM()};
}

// What patches are made by: a triangle's middle and unit normal along the axes of the chunk's box, which in a baked
// chunk are east, north, up. The normal of a triangle without area is 0.
struct TriangleShape {
  Vec3d centreM;  // from the box's centre
  Vec3d normal;
};
std::vector<TriangleShape> triangleShapes(const ChunkMesh& mesh, const MeshPlace& place);

// Triangles (numbers of the index list's threes) cluster by cluster, and how many each cluster has, none of them 0.
struct TriangleGroups {
  std::vector<uint32_t> order;
  std::vector<uint32_t> counts;
};

// Compact patches: halved across their longest extent until none has more than `mostTriangles`.
TriangleGroups groupByPlace(const std::vector<TriangleShape>& triangles, uint32_t mostTriangles);

// Puts the index list into the order of the groups, within a cluster into one that a vertex cache likes, and bounds
// each. All vertices of triangles must lie in the box. Vertices keep their order.
void setClusters(const TriangleGroups& groups, const MeshPlace& place, ChunkMesh& mesh);

// Both, as the bake does it.
void buildClusters(const MeshPlace& place, ChunkMesh& mesh);

OrientedBox clusterBox(const OrientedBox& chunkBox, const ChunkCluster& cluster);
// The cone's test in double precision, as ChunkCluster has it. `box` is the cluster's.
bool facesAway(const ChunkCluster& cluster, const OrientedBox& box, const Vec3d& eyeEcefM);
// The cone holds the normals of the cluster's triangles, with all roundings.
bool coneHolds(const ChunkMesh& mesh, const ChunkCluster& cluster);

}  // namespace eye
