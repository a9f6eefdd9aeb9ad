// Clusters against brute force, for made and for baked meshes.
#pragma once

#include <cmath>
#include <random>

#include <catch2/catch.hpp>

#include "terrain/clusters.h"

namespace eye::test {

inline Vec3d pointOf(const ChunkMesh& mesh, const MeshPlace& place, size_t index) {
  const ChunkVertex& v = mesh.vertices[mesh.indices[index]];
  return ecefFromLattice(place.originLattice + LatticePoint(v.x, v.y, v.z), place.stepM);
}

// Without any tolerance: runs cover the triangles, boxes hold them, cones hold their normals.
inline void requireBoundsHold(const ChunkMesh& mesh, const MeshPlace& place) {
  size_t covered = 0, outside = 0, conesBroken = 0;
  for (const ChunkCluster& cluster : mesh.clusters) {
    REQUIRE(cluster.firstIndex == covered);
    REQUIRE((cluster.indexCount > 0 && cluster.indexCount % 3 == 0));
    covered += cluster.indexCount;
    const OrientedBox box = clusterBox(place.box, cluster);
    for (size_t i = cluster.firstIndex; i < covered; ++i) {
      const Vec3d offset = pointOf(mesh, place, i) - box.centreEcefM;
      for (const Vec3d& axis : box.halfAxesEcefM)
        if (std::abs(glm::dot(offset, axis)) > glm::dot(axis, axis)) ++outside;
    }
    if (!coneHolds(mesh, cluster)) ++conesBroken;
  }
  REQUIRE(covered == mesh.indices.size());
  REQUIRE(outside == 0);
  REQUIRE(conesBroken == 0);
}

struct ConeTally {
  uint64_t tried = 0, away = 0, allAway = 0, wrong = 0, wrongInFloats = 0;
};

// The test as a shader makes it, in single precision and relative to the eye.
inline bool facesAwayInFloats(const ChunkCluster& cluster, const OrientedBox& box, const Vec3d& eyeEcefM) {
  const glm::vec3 sight(box.centreEcefM - eyeEcefM);
  const glm::vec3 x(box.halfAxesEcefM[0]), y(box.halfAxesEcefM[1]), z(box.halfAxesEcefM[2]);
  const float radius = std::sqrt(glm::dot(x, x) + glm::dot(y, y) + glm::dot(z, z));
  const glm::vec3 axis = glm::vec3(cluster.coneAxis[0], cluster.coneAxis[1], cluster.coneAxis[2]) / 127.0f;
  return glm::dot(sight, axis) >= static_cast<float>(cluster.coneCutoff) / 127.0f * glm::length(sight) + radius;
}

// Each cluster from `eyes` places: anywhere about it from inside to far away, most of them near where its cone's test
// turns.
inline void tryEyes(const ChunkMesh& mesh, const MeshPlace& place, int eyes, std::mt19937& random, ConeTally& tally) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const ChunkCluster& cluster : mesh.clusters) {
    const OrientedBox box = clusterBox(place.box, cluster);
    double radiusM = 0;
    for (const Vec3d& half : box.halfAxesEcefM) radiusM = std::hypot(radiusM, glm::length(half));
    const Vec3d axis = Vec3d(cluster.coneAxis[0], cluster.coneAxis[1], cluster.coneAxis[2]) / 127.0;
    for (int i = 0; i < eyes; ++i) {
      Vec3d sight = glm::normalize(Vec3d(normal(random), normal(random), normal(random)) + 1e-12);
      const double distanceM = radiusM * std::pow(10.0, 6 * uniform(random) - 1);
      if (axis != Vec3d(0.0) && i % 4 != 0) {
        // Right about where the test turns: dot(sight, axis) = cutoff + radius / distance.
        const double turns = std::min(1.0, cluster.coneCutoff / 127.0 + radiusM / distanceM);
        const double along = std::min(1.0, turns + (i % 4 == 1 ? 0.05 : 0.0005) * normal(random));
        const Vec3d across = sight - axis * glm::dot(sight, axis);
        sight = axis * along + glm::normalize(across) * std::sqrt(std::max(0.0, 1 - along * along));
      }
      const Vec3d eyeM = box.centreEcefM - sight * distanceM;
      bool isAllAway = true;
      for (size_t t = cluster.firstIndex; t < cluster.firstIndex + cluster.indexCount && isAllAway; t += 3) {
        const Vec3d a = pointOf(mesh, place, t) - eyeM;
        const Vec3d b = pointOf(mesh, place, t + 1) - eyeM, c = pointOf(mesh, place, t + 2) - eyeM;
        const Vec3d area = glm::cross(b - a, c - a);
        // Sums of this size are off by some 1e-15 of their parts.
        isAllAway = glm::dot(area, a) >= -1e-9 * glm::length(area) * glm::length(a);
      }
      const bool isAway = facesAway(cluster, box, eyeM);
      ++tally.tried;
      if (isAllAway) ++tally.allAway;
      if (isAway) ++tally.away;
      if (isAway && !isAllAway) ++tally.wrong;
      if (facesAwayInFloats(cluster, box, eyeM) && !isAllAway) ++tally.wrongInFloats;
    }
  }
}

}  // namespace eye::test
