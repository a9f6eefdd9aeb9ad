// The study's parts: ways of grouping keep every triangle, the depth map hides what is behind.
#include <algorithm>

#include <catch2/catch.hpp>

#include "bench/cluster_methods.h"
#include "bench/depth_probe.h"

namespace eye {
namespace {

// A wavy sheet of edges * edges squares about 49 N 20 E.
ChunkMesh wavySheet(int edges, MeshPlace& place) {
  ChunkMesh mesh;
  const Mat3d axes = ecefFromEnu(49, 20);
  place.box.centreEcefM = ecefFromGeodetic({49, 20, 1000});
  place.box.halfAxesEcefM = {axes[0] * 2000.0, axes[1] * 2000.0, axes[2] * 400.0};
  place.originLattice = latticeFromEcef(place.box.centreEcefM, place.stepM);
  for (int j = 0; j <= edges; ++j) {
    for (int i = 0; i <= edges; ++i) {
      const double x = 3000.0 * i / edges - 1500, y = 3000.0 * j / edges - 1500;
      const Vec3d p = glm::round(axes * Vec3d(x, y, 300 * std::sin(x / 300) * std::cos(y / 400)));
      mesh.vertices.push_back(
          {static_cast<int16_t>(p.x), static_cast<int16_t>(p.y), static_cast<int16_t>(p.z), 0, 0, 0, 0, 0});
    }
  }
  for (int j = 0; j < edges; ++j) {
    for (int i = 0; i < edges; ++i) {
      const auto a = static_cast<uint16_t>(j * (edges + 1) + i), b = static_cast<uint16_t>(a + 1);
      const auto d = static_cast<uint16_t>(a + edges + 1), c = static_cast<uint16_t>(d + 1);
      mesh.indices.insert(mesh.indices.end(), {a, b, c, a, c, d});
    }
  }
  return mesh;
}

void checkGroups(const TriangleGroups& groups, size_t triangles, uint32_t most) {
  std::vector<uint32_t> sorted = groups.order;
  std::ranges::sort(sorted);
  REQUIRE(sorted.size() == triangles);
  for (uint32_t i = 0; i < triangles; ++i) REQUIRE(sorted[i] == i);
  size_t sum = 0;
  for (const uint32_t count : groups.counts) {
    REQUIRE((count > 0 && count <= most));
    sum += count;
  }
  REQUIRE(sum == triangles);
}

}  // namespace

TEST_CASE("However triangles are grouped, each is in one cluster, and none is larger than it may be") {
  MeshPlace place;
  const ChunkMesh mesh = wavySheet(30, place);
  const std::vector<TriangleShape> shapes = triangleShapes(mesh, place);
  for (const uint32_t most : {1u, 8u, 64u, 500u}) {
    checkGroups(groupByPlace(shapes, most), shapes.size(), most);
    checkGroups(groupByAspect(shapes, most, 4), shapes.size(), most);
    checkGroups(groupByPlaceAndFacing(shapes, most, 1.0), shapes.size(), most);
    if (most >= 8) checkGroups(groupByMeshlets(mesh, most, 0.5f), shapes.size(), most);
  }
}

TEST_CASE("Grouped by facing, cones are narrower than grouped by place") {
  MeshPlace place;
  const ChunkMesh mesh = wavySheet(30, place);
  const std::vector<TriangleShape> shapes = triangleShapes(mesh, place);
  const auto meanCutoff = [&](const TriangleGroups& groups) {
    ChunkMesh made = mesh;
    setClusters(groups, place, made);
    double sum = 0;
    for (const ChunkCluster& cluster : made.clusters) sum += cluster.coneCutoff;
    return sum / static_cast<double>(made.clusters.size());
  };
  const double byPlace = meanCutoff(groupByPlace(shapes, 64));
  CHECK(meanCutoff(groupByAspect(shapes, 64, 8)) < byPlace);
  CHECK(meanCutoff(groupByPlaceAndFacing(shapes, 64, 1.0)) < byPlace);
}

TEST_CASE("A wall hides what is wholly behind it and nothing else") {
  const View view = makeView({{49, 20, 500}, 0, 0, 0}, symmetricFrustum(90, 200, 150, 1), 200, 150);
  const Mat3d axes = ecefFromEnu(49, 20);
  const auto at = [&](double east, double north, double up) { return axes * Vec3d(east, north, up); };
  const auto box = [&](double east, double north, double up, double halfM) {
    return OrientedBox{view.eyeEcefM + at(east, north, up), {axes[0] * halfM, axes[1] * halfM, axes[2] * halfM}};
  };
  DepthProbe probe(view);
  CHECK(probe.judge(box(0, 300, 0, 10)) == BoxVerdict::visible);  // before the sky
  // 80 m wide and high, 100 m ahead.
  probe.draw(at(-40, 100, -40), at(40, 100, -40), at(40, 100, 40));
  probe.draw(at(-40, 100, -40), at(40, 100, 40), at(-40, 100, 40));
  CHECK(probe.judge(box(0, 300, 0, 10)) == BoxVerdict::occluded);
  CHECK(probe.judge(box(100, 300, 100, 10)) == BoxVerdict::occluded);  // its shadow grows with distance
  CHECK(probe.judge(box(115, 300, 0, 10)) == BoxVerdict::visible);     // looks out at the side
  CHECK(probe.judge(box(0, 105, 0, 10)) == BoxVerdict::visible);       // stands in the wall
  CHECK(probe.judge(box(0, 80, 0, 10)) == BoxVerdict::visible);        // before it
  CHECK(probe.judge(box(0, 0, 0, 10)) == BoxVerdict::visible);         // about the eye
  CHECK(probe.judge(box(500, 300, 0, 10)) == BoxVerdict::outside);
  CHECK(probe.judge(box(0, -300, 0, 10)) == BoxVerdict::outside);
}

}  // namespace eye
