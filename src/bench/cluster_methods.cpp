#include "bench/cluster_methods.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <meshoptimizer.h>

namespace eye {
namespace {

constexpr double kPi = 3.14159265358979323846;
// Below this slope a triangle faces up and no side: eyes above the ground see it from wherever they are.
const double kLevelNormalUp = std::cos(radFromDeg(10.0));

using Traits = std::array<double, 6>;

void split(const std::vector<Traits>& traits, size_t begin, size_t end, size_t parts, TriangleGroups& out) {
  if (parts == 1) {
    out.counts.push_back(static_cast<uint32_t>(end - begin));
    return;
  }
  size_t widest = 0;
  double extent = -1;
  for (size_t k = 0; k < 6; ++k) {
    double low = traits[out.order[begin]][k], high = low;
    for (size_t i = begin; i < end; ++i) {
      low = std::min(low, traits[out.order[i]][k]);
      high = std::max(high, traits[out.order[i]][k]);
    }
    if (high - low <= extent) continue;
    extent = high - low;
    widest = k;
  }
  const size_t lowerParts = parts / 2, middle = begin + (end - begin) * lowerParts / parts;
  const auto at = [&](size_t i) { return out.order.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(middle), at(end), [&](uint32_t a, uint32_t b) {
    return traits[a][widest] != traits[b][widest] ? traits[a][widest] < traits[b][widest] : a < b;
  });
  split(traits, begin, middle, lowerParts, out);
  split(traits, middle, end, parts - lowerParts, out);
}

}  // namespace

TriangleGroups groupByMeshlets(const ChunkMesh& mesh, uint32_t mostTriangles, float coneWeight) {
  constexpr size_t kMostVertices = 255;  // the library's limit
  const std::vector<unsigned> indices(mesh.indices.begin(), mesh.indices.end());
  std::vector<glm::vec3> positions;
  for (const ChunkVertex& v : mesh.vertices) positions.emplace_back(v.x, v.y, v.z);
  const size_t bound = meshopt_buildMeshletsBound(indices.size(), kMostVertices, mostTriangles);
  std::vector<meshopt_Meshlet> meshlets(bound);
  std::vector<unsigned> vertices(bound * kMostVertices);
  std::vector<unsigned char> corners(bound * mostTriangles * 3);
  const size_t count = meshopt_buildMeshlets(meshlets.data(), vertices.data(), corners.data(), indices.data(),
                                             indices.size(), &positions[0].x, positions.size(), sizeof(glm::vec3),
                                             kMostVertices, mostTriangles, coneWeight);
  // Meshlets hold vertices, not numbers of triangles: three corners tell which one it is.
  using Corners = std::array<unsigned, 3>;
  std::multimap<Corners, uint32_t> numberOf;
  for (size_t i = 0; i < indices.size(); i += 3) {
    Corners key{indices[i], indices[i + 1], indices[i + 2]};
    std::ranges::sort(key);
    numberOf.emplace(key, static_cast<uint32_t>(i / 3));
  }
  TriangleGroups groups;
  for (size_t m = 0; m < count; ++m) {
    const meshopt_Meshlet& meshlet = meshlets[m];
    for (size_t i = 0; i < size_t{3} * meshlet.triangle_count; i += 3) {
      Corners key{};
      for (size_t k = 0; k < 3; ++k)
        key[k] = vertices[meshlet.vertex_offset + corners[meshlet.triangle_offset + i + k]];
      std::ranges::sort(key);
      const auto found = numberOf.find(key);
      EYE_CHECK(found != numberOf.end());
      groups.order.push_back(found->second);
      numberOf.erase(found);
    }
    groups.counts.push_back(meshlet.triangle_count);
  }
  return groups;
}

TriangleGroups groupByAspect(const std::vector<TriangleShape>& triangles, uint32_t mostTriangles, int sectors) {
  std::vector<std::vector<uint32_t>> members(static_cast<size_t>(sectors) + 1);  // level ones last
  for (uint32_t t = 0; t < triangles.size(); ++t) {
    const Vec3d& normal = triangles[t].normal;
    size_t sector = static_cast<size_t>(sectors);
    if (normal.z < kLevelNormalUp) {
      const double turn = std::atan2(normal.y, normal.x) / (2 * kPi) + 0.5;
      sector = std::min(static_cast<size_t>(turn * sectors), static_cast<size_t>(sectors) - 1);
    }
    members[sector].push_back(t);
  }
  TriangleGroups groups;
  for (const std::vector<uint32_t>& sector : members) {
    std::vector<TriangleShape> shapes;
    for (const uint32_t t : sector) shapes.push_back(triangles[t]);
    const TriangleGroups patches = groupByPlace(shapes, mostTriangles);
    for (const uint32_t i : patches.order) groups.order.push_back(sector[i]);
    groups.counts.insert(groups.counts.end(), patches.counts.begin(), patches.counts.end());
  }
  return groups;
}

TriangleGroups groupByPlaceAndFacing(const std::vector<TriangleShape>& triangles, uint32_t mostTriangles,
                                     double facingWeight) {
  TriangleGroups groups;
  groups.order.resize(triangles.size());
  std::iota(groups.order.begin(), groups.order.end(), 0u);
  if (triangles.empty()) return groups;
  double halfWidthM = 1e-9;
  for (const TriangleShape& t : triangles)
    halfWidthM = std::max({halfWidthM, std::abs(t.centreM.x), std::abs(t.centreM.y)});
  std::vector<Traits> traits;
  for (const TriangleShape& t : triangles) {
    const Vec3d place = t.centreM / halfWidthM, facing = t.normal * facingWeight;
    traits.push_back({place.x, place.y, place.z, facing.x, facing.y, facing.z});
  }
  split(traits, 0, triangles.size(), (triangles.size() + mostTriangles - 1) / mostTriangles, groups);
  return groups;
}

}  // namespace eye
