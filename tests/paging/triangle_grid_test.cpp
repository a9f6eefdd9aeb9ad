#include "paging/triangle_grid.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

namespace eye {
namespace {

// A lattice of crooked triangles.
ChunkMesh crooked(int posts, std::mt19937& random) {
  std::uniform_real_distribution<double> jitter(-0.4, 0.4);
  ChunkMesh mesh;
  for (int row = 0; row < posts; ++row) {
    for (int column = 0; column < posts; ++column) {
      const auto at = [&](int post) {
        const bool isEdge = post == 0 || post == posts - 1;
        return static_cast<uint16_t>((post + (isEdge ? 0 : jitter(random))) / (posts - 1) * 65535);
      };
      ChunkVertex vertex{};
      vertex.s = at(column);
      vertex.t = at(row);
      mesh.vertices.push_back(vertex);
    }
  }
  for (int row = 0; row + 1 < posts; ++row) {
    for (int column = 0; column + 1 < posts; ++column) {
      const int corner = row * posts + column;
      for (const int index : {corner, corner + 1, corner + posts, corner + 1, corner + posts + 1, corner + posts})
        mesh.indices.push_back(static_cast<uint16_t>(index));
    }
  }
  return mesh;
}

}  // namespace

TEST_CASE("every place finds its triangle in the grid, and few others") {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(0, 1);
  for (const int posts : {2, 9, 17, 40}) {
    const ChunkMesh mesh = crooked(posts, random);
    const TriangleGrid grid(mesh);
    const size_t triangles = mesh.indices.size() / 3;
    size_t found = 0;
    for (int i = 0; i < 2000; ++i) {
      const size_t first = 3 * static_cast<size_t>(unit(random) * static_cast<double>(triangles));
      const double weights[3] = {unit(random), unit(random), unit(random)};
      double s = 0, t = 0;
      for (size_t k = 0; k < 3; ++k) {
        const ChunkVertex& vertex = mesh.vertices[mesh.indices[first + k]];
        const double share = weights[k] / (weights[0] + weights[1] + weights[2]) / 65535;
        s += share * vertex.s;
        t += share * vertex.t;
      }
      const auto near = grid.near(s, t);
      INFO(posts << " posts, at " << s << " " << t);
      REQUIRE(std::ranges::find(near, first) != near.end());
      found += near.size();
    }
    if (posts >= 17) CHECK(found < 2000 * triangles / 20);
  }
}

}  // namespace eye
