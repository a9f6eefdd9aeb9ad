#include "terrain/clusters.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <meshoptimizer.h>

namespace eye {
namespace {

// Boxes grow by this on each side, metres: a thousand times what doubles of the Earth's size are off.
constexpr double kOutwardM = 1e-6;
// Added to a cone's cutoff, radians: what is nearer to edge-on than this is drawn. Rounding to 1/256 of a pixel may
// turn such a triangle to the eye where it is not much larger than a pixel. Far more than what single precision is off.
constexpr double kCutoffSlack = 0.01;
constexpr int kAxisSteps = 32;

// Twice the triangle's area along its normal, in lattice steps: exact, as lattice differences have 17 bits.
Vec3d areaNormal(const ChunkMesh& mesh, size_t firstIndex) {
  const auto corner = [&](size_t i) {
    const ChunkVertex& v = mesh.vertices[mesh.indices[firstIndex + i]];
    return Vec3d(v.x, v.y, v.z);
  };
  const Vec3d a = corner(0);
  return glm::cross(corner(1) - a, corner(2) - a);
}

// A triangle without area covers no pixel: it faces nowhere.
Vec3d unitOrZero(const Vec3d& v) {
  const double length = glm::length(v);
  return length > 0 ? v / length : Vec3d(0.0);
}

double lowestDot(const std::vector<Vec3d>& normals, const Vec3d& axis, size_t& lowest) {
  double least = 1.0;
  for (size_t i = 0; i < normals.size(); ++i) {
    const double dot = glm::dot(normals[i], axis);
    if (dot >= least) continue;
    least = dot;
    lowest = i;
  }
  return least;
}

// About the middle of the smallest cone that holds all normals: steps towards the one that is farthest off, ever
// shorter (Badoiu and Clarkson 2003).
Vec3d coneAxis(const std::vector<Vec3d>& normals) {
  Vec3d sum(0.0);
  for (const Vec3d& normal : normals) sum += normal;
  Vec3d axis = unitOrZero(sum), best = axis;
  double bestDot = -1.0;
  for (int step = 1; step <= kAxisSteps; ++step) {
    size_t farthest = 0;
    const double dot = lowestDot(normals, axis, farthest);
    if (dot > bestDot) {
      bestDot = dot;
      best = axis;
    }
    axis = unitOrZero(axis + (normals[farthest] - axis) / (step + 1.0));
  }
  return best;
}

Vec3d storedAxis(const ChunkCluster& cluster) {
  return Vec3d(cluster.coneAxis[0], cluster.coneAxis[1], cluster.coneAxis[2]) / 127.0;
}

// The cutoff that the axis as stored asks for; above 1 where no eye sees all triangles from behind.
// For normals within an angle alpha of the axis it is sin(alpha): with the axis at an angle of 90 degrees - phi to the
// line of sight, sin(phi) >= sin(alpha) + r / d gives sin(phi - alpha) >= r / d, so that the whole sphere lies behind
// each triangle's plane. An axis longer than a unit makes the left side of the test larger by what it is longer.
double neededCutoff(const std::vector<Vec3d>& normals, const Vec3d& axis) {
  const double length = glm::length(axis);
  if (length == 0) return 2.0;
  size_t ignored = 0;
  const double leastDot = lowestDot(normals, axis / length, ignored);
  if (leastDot <= 0) return 2.0;
  return std::sqrt(std::max(0.0, 1.0 - leastDot * leastDot)) + std::max(0.0, length - 1.0);
}

void normalsOf(const ChunkMesh& mesh, const ChunkCluster& cluster, std::vector<Vec3d>& normals) {
  normals.clear();
  for (size_t i = cluster.firstIndex; i < cluster.firstIndex + cluster.indexCount; i += 3) {
    const Vec3d normal = areaNormal(mesh, i);
    if (normal != Vec3d(0.0)) normals.push_back(unitOrZero(normal));
  }
}

void setCone(const ChunkMesh& mesh, ChunkCluster& cluster) {
  thread_local std::vector<Vec3d> normals;
  normalsOf(mesh, cluster, normals);
  if (normals.empty()) return;
  const Vec3d axis = coneAxis(normals);
  ChunkCluster rounded = cluster;
  for (int i = 0; i < 3; ++i)
    rounded.coneAxis[static_cast<size_t>(i)] = static_cast<int8_t>(std::lround(axis[i] * 127.0));
  const double cutoff = std::ceil((neededCutoff(normals, storedAxis(rounded)) + kCutoffSlack) * 127.0);
  if (cutoff >= 127.0) return;
  cluster.coneAxis = rounded.coneAxis;
  cluster.coneCutoff = static_cast<int8_t>(cutoff);
}

void setBox(const ChunkMesh& mesh, const MeshPlace& place, ChunkCluster& cluster) {
  Vec3d low(1.0), high(-1.0);  // along the half axes
  for (size_t i = cluster.firstIndex; i < cluster.firstIndex + cluster.indexCount; ++i) {
    const ChunkVertex& v = mesh.vertices[mesh.indices[i]];
    const Vec3d p = ecefFromLattice(place.originLattice + LatticePoint(v.x, v.y, v.z), place.stepM);
    for (int a = 0; a < 3; ++a) {
      const Vec3d& axis = place.box.halfAxesEcefM[static_cast<size_t>(a)];
      const double lengthSquared = glm::dot(axis, axis);
      const double along = lengthSquared > 0 ? glm::dot(p - place.box.centreEcefM, axis) / lengthSquared : 0.0;
      low[a] = std::min(low[a], along);
      high[a] = std::max(high[a], along);
    }
  }
  for (int a = 0; a < 3; ++a) {
    const double halfM = glm::length(place.box.halfAxesEcefM[static_cast<size_t>(a)]);
    const double outward = halfM > 0 ? kOutwardM / halfM : 1.0;
    const auto quantised = [](double along) { return std::clamp((along + 1.0) / 2.0, 0.0, 1.0) * 65535.0; };
    cluster.boxMin[static_cast<size_t>(a)] = static_cast<uint16_t>(std::floor(quantised(low[a] - outward)));
    cluster.boxMax[static_cast<size_t>(a)] = static_cast<uint16_t>(std::ceil(quantised(high[a] + outward)));
  }
}

// Appends the triangles to `indices` in an order that a vertex cache likes.
void appendInCacheOrder(const ChunkMesh& mesh, std::span<const uint32_t> triangles, std::vector<uint16_t>& indices) {
  constexpr uint32_t kUnused = ~uint32_t{0};
  thread_local std::vector<uint32_t> localOf;  // of the mesh's vertices; all unused between calls
  thread_local std::vector<uint32_t> local, ordered;
  thread_local std::vector<uint16_t> vertexOf;
  localOf.resize(std::max(localOf.size(), mesh.vertices.size()), kUnused);
  local.clear();
  vertexOf.clear();
  for (const uint32_t triangle : triangles) {
    for (size_t i = size_t{3} * triangle; i < size_t{3} * triangle + 3; ++i) {
      const uint16_t vertex = mesh.indices[i];
      if (localOf[vertex] == kUnused) {
        localOf[vertex] = static_cast<uint32_t>(vertexOf.size());
        vertexOf.push_back(vertex);
      }
      local.push_back(localOf[vertex]);
    }
  }
  for (const uint16_t vertex : vertexOf) localOf[vertex] = kUnused;
  ordered.resize(local.size());
  meshopt_optimizeVertexCache(ordered.data(), local.data(), local.size(), vertexOf.size());
  for (const uint32_t corner : ordered) indices.push_back(vertexOf[corner]);
}

// Halves the triangles in [begin, end) across the longest extent of their middles, for `parts` clusters.
void split(const std::vector<TriangleShape>& triangles, size_t begin, size_t end, size_t parts, TriangleGroups& out) {
  if (parts == 1) {
    out.counts.push_back(static_cast<uint32_t>(end - begin));
    return;
  }
  Vec3d low = triangles[out.order[begin]].centreM, high = low;
  for (size_t i = begin; i < end; ++i) {
    low = glm::min(low, triangles[out.order[i]].centreM);
    high = glm::max(high, triangles[out.order[i]].centreM);
  }
  const Vec3d extent = high - low;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const size_t lowerParts = parts / 2, middle = begin + (end - begin) * lowerParts / parts;
  const auto at = [&](size_t i) { return out.order.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(middle), at(end), [&](uint32_t a, uint32_t b) {
    const double alongA = triangles[a].centreM[axis], alongB = triangles[b].centreM[axis];
    return alongA != alongB ? alongA < alongB : a < b;
  });
  split(triangles, begin, middle, lowerParts, out);
  split(triangles, middle, end, parts - lowerParts, out);
}

// Triangles of a cluster at most, see docs/CULLING.md.
constexpr uint32_t kMostTriangles = 64;

}  // namespace

std::vector<TriangleShape> triangleShapes(const ChunkMesh& mesh, const MeshPlace& place) {
  const Vec3d originM = ecefFromLattice(place.originLattice, place.stepM) - place.box.centreEcefM;
  glm::dmat3 axes;
  for (int a = 0; a < 3; ++a) axes[a] = unitOrZero(place.box.halfAxesEcefM[static_cast<size_t>(a)]);
  std::vector<TriangleShape> shapes(mesh.indices.size() / 3);
  for (size_t t = 0; t < shapes.size(); ++t) {
    Vec3d sum(0.0);
    for (size_t i = 3 * t; i < 3 * t + 3; ++i) {
      const ChunkVertex& v = mesh.vertices[mesh.indices[i]];
      sum += Vec3d(v.x, v.y, v.z);
    }
    shapes[t].centreM = (originM + sum * (place.stepM / 3.0)) * axes;
    shapes[t].normal = unitOrZero(areaNormal(mesh, 3 * t)) * axes;
  }
  return shapes;
}

TriangleGroups groupByPlace(const std::vector<TriangleShape>& triangles, uint32_t mostTriangles) {
  TriangleGroups groups;
  groups.order.resize(triangles.size());
  std::iota(groups.order.begin(), groups.order.end(), 0u);
  if (triangles.empty()) return groups;
  split(triangles, 0, triangles.size(), (triangles.size() + mostTriangles - 1) / mostTriangles, groups);
  return groups;
}

void setClusters(const TriangleGroups& groups, const MeshPlace& place, ChunkMesh& mesh) {
  EYE_CHECK(groups.order.size() * 3 == mesh.indices.size());
  std::vector<uint16_t> indices;
  indices.reserve(mesh.indices.size());
  mesh.clusters.clear();
  std::span<const uint32_t> left = groups.order;
  for (const uint32_t count : groups.counts) {
    ChunkCluster& cluster = mesh.clusters.emplace_back();
    cluster.firstIndex = static_cast<uint32_t>(indices.size());
    cluster.indexCount = 3 * count;
    appendInCacheOrder(mesh, left.first(count), indices);
    left = left.subspan(count);
  }
  EYE_CHECK(left.empty());
  mesh.indices = std::move(indices);
  for (ChunkCluster& cluster : mesh.clusters) {
    setBox(mesh, place, cluster);
    setCone(mesh, cluster);
  }
}

void buildClusters(const MeshPlace& place, ChunkMesh& mesh) {
  setClusters(groupByPlace(triangleShapes(mesh, place), kMostTriangles), place, mesh);
}

OrientedBox clusterBox(const OrientedBox& chunkBox, const ChunkCluster& cluster) {
  OrientedBox box = chunkBox;
  for (size_t a = 0; a < 3; ++a) {
    const double low = 2.0 * cluster.boxMin[a] / 65535.0 - 1.0, high = 2.0 * cluster.boxMax[a] / 65535.0 - 1.0;
    box.centreEcefM += chunkBox.halfAxesEcefM[a] * ((low + high) / 2.0);
    box.halfAxesEcefM[a] = chunkBox.halfAxesEcefM[a] * ((high - low) / 2.0);
  }
  return box;
}

bool facesAway(const ChunkCluster& cluster, const OrientedBox& box, const Vec3d& eyeEcefM) {
  const auto& axes = box.halfAxesEcefM;
  const double radiusM =
      std::sqrt(glm::dot(axes[0], axes[0]) + glm::dot(axes[1], axes[1]) + glm::dot(axes[2], axes[2]));
  const Vec3d sightM = box.centreEcefM - eyeEcefM;
  return glm::dot(sightM, storedAxis(cluster)) >= cluster.coneCutoff / 127.0 * glm::length(sightM) + radiusM;
}

bool coneHolds(const ChunkMesh& mesh, const ChunkCluster& cluster) {
  if (cluster.coneCutoff == 127 && cluster.coneAxis == std::array<int8_t, 3>{}) return true;
  std::vector<Vec3d> normals;
  normalsOf(mesh, cluster, normals);
  return neededCutoff(normals, storedAxis(cluster)) <= cluster.coneCutoff / 127.0;
}

}  // namespace eye
