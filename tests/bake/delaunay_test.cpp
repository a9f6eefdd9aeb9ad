// The triangulation against its definition: covers the polygon, no point inside a circumcircle.
#include "bake/delaunay.h"

#include <algorithm>
#include <random>

#include <catch2/catch.hpp>

using namespace eye;

namespace {

size_t at(int32_t i) {
  return static_cast<size_t>(i);
}

int64_t doubleArea(const std::vector<PlanarPoint>& loop) {
  int64_t sum = 0;
  for (size_t i = 1; i + 1 < loop.size(); ++i) sum += orientation(loop[0], loop[i], loop[i + 1]);
  return sum;
}

// Every triangle counterclockwise, neighbours mutual, the area the polygon's, the polygon's edges the border.
void checkTopology(const Triangulation& mesh, const std::vector<PlanarPoint>& loop) {
  int64_t area = 0;
  size_t borderEdges = 0, notMutual = 0, turnedOver = 0, foreignBorder = 0;
  const auto& points = mesh.points();
  for (size_t t = 0; t < mesh.triangles().size(); ++t) {
    const Triangulation::Triangle& triangle = mesh.triangles()[t];
    const int64_t a =
        orientation(points[at(triangle.vertex[0])], points[at(triangle.vertex[1])], points[at(triangle.vertex[2])]);
    turnedOver += a <= 0;
    area += a;
    for (size_t i = 0; i < 3; ++i) {
      const int32_t from = triangle.vertex[(i + 1) % 3], to = triangle.vertex[(i + 2) % 3];
      if (triangle.neighbour[i] == kNoTriangle) {
        ++borderEdges;
        foreignBorder += at(to) != (at(from) + 1) % loop.size();
        continue;
      }
      const Triangulation::Triangle& other = mesh.triangles()[at(triangle.neighbour[i])];
      bool isMutual = false;
      for (size_t k = 0; k < 3; ++k) {
        isMutual = isMutual || (other.neighbour[k] == static_cast<int32_t>(t) && other.vertex[(k + 1) % 3] == to &&
                                other.vertex[(k + 2) % 3] == from);
      }
      notMutual += !isMutual;
    }
  }
  CHECK(turnedOver == 0);
  CHECK(notMutual == 0);
  CHECK(foreignBorder == 0);
  CHECK(borderEdges == loop.size());
  CHECK(area == doubleArea(loop));
  CHECK(mesh.triangles().size() == 2 * points.size() - loop.size() - 2);
}

// Of a convex polygon: empty circles against every point.
size_t pointsInsideCircles(const Triangulation& mesh) {
  size_t inside = 0;
  const auto& points = mesh.points();
  for (const Triangulation::Triangle& t : mesh.triangles()) {
    for (const PlanarPoint& p : points) {
      inside += inCircle(points[at(t.vertex[0])], points[at(t.vertex[1])], points[at(t.vertex[2])], p) > 0;
    }
  }
  return inside;
}

std::vector<PlanarPoint> square(int32_t half, int32_t perSide) {
  std::vector<PlanarPoint> loop;
  const int32_t step = 2 * half / perSide;
  for (int32_t i = 0; i < perSide; ++i) loop.push_back({-half + i * step, -half});
  for (int32_t i = 0; i < perSide; ++i) loop.push_back({half, -half + i * step});
  for (int32_t i = 0; i < perSide; ++i) loop.push_back({half - i * step, half});
  for (int32_t i = 0; i < perSide; ++i) loop.push_back({-half, half - i * step});
  return loop;
}

}  // namespace

TEST_CASE("Predicates are exact where doubles are not") {
  const int32_t big = 1 << 24;
  CHECK(inCircle({-big, -big}, {big, -big}, {big, big}, {-big, big}) == 0);
  CHECK(inCircle({-big, -big}, {big, -big}, {big, big}, {-big, big - 1}) == 1);
  CHECK(inCircle({-big, -big}, {big, -big}, {big, big - 1}, {-big, big}) == -1);
  CHECK(orientation({-big, -big}, {0, 0}, {big, big}) == 0);
  CHECK(orientation({-big, -big}, {0, 0}, {big, big - 1}) == -int64_t{big});
}

TEST_CASE("Random points in a square keep the Delaunay property") {
  std::mt19937 random(7);
  const std::vector<PlanarPoint> loop = square(1 << 20, 8);
  Triangulation mesh;
  REQUIRE(mesh.reset(loop));
  checkTopology(mesh, loop);
  std::uniform_int_distribution<int32_t> coordinate(-(1 << 20) + 1, (1 << 20) - 1);
  for (int i = 0; i < 400; ++i) REQUIRE(mesh.insert({coordinate(random), coordinate(random)}, 0) != kNoVertex);
  checkTopology(mesh, loop);
  CHECK(pointsInsideCircles(mesh) == 0);
}

TEST_CASE("Collinear and cocircular points: a grid in random order") {
  std::vector<PlanarPoint> grid;
  for (int32_t y = -9; y <= 9; ++y) {
    for (int32_t x = -9; x <= 9; ++x) grid.push_back({x * 100, y * 100});
  }
  std::shuffle(grid.begin(), grid.end(), std::mt19937(3));
  const std::vector<PlanarPoint> loop = square(1000, 20);
  Triangulation mesh;
  REQUIRE(mesh.reset(loop));
  int32_t last = 0;
  for (const PlanarPoint& p : grid) {
    REQUIRE(mesh.insert(p, last) != kNoVertex);
    last = mesh.created().front();
  }
  checkTopology(mesh, loop);
  CHECK(pointsInsideCircles(mesh) == 0);
  for (const PlanarPoint& p : grid) CHECK(mesh.insert(p, 0) == kNoVertex);
}

TEST_CASE("Points on the polygon, on its corners and outside are refused") {
  const std::vector<PlanarPoint> loop = square(1000, 4);
  Triangulation mesh;
  REQUIRE(mesh.reset(loop));
  CHECK(mesh.insert({1000, 17}, 0) == kNoVertex);
  CHECK(mesh.insert({-1000, -1000}, 0) == kNoVertex);
  CHECK(mesh.insert({1001, 17}, 0) == kNoVertex);
  checkTopology(mesh, loop);
  CHECK(mesh.insert({999, 17}, 0) != kNoVertex);
  checkTopology(mesh, loop);
}

TEST_CASE("A polygon with hollow sides keeps its edges and its area") {
  // One side bends inwards as a parallel does, one outwards; points are strewn close to both.
  std::vector<PlanarPoint> loop;
  for (int32_t i = 0; i < 20; ++i) loop.push_back({-10000 + i * 1000, -10000 - (400 - (i - 10) * (i - 10) * 4)});
  for (int32_t i = 0; i < 20; ++i) loop.push_back({10000 - i * 1000, 10000 - (400 - (i - 10) * (i - 10) * 4)});
  std::mt19937 random(11);
  std::uniform_int_distribution<int32_t> coordinate(-10400, 10400);
  Triangulation mesh;
  REQUIRE(mesh.reset(loop));
  checkTopology(mesh, loop);
  size_t inserted = 0;
  for (int i = 0; i < 3000; ++i) inserted += mesh.insert({coordinate(random), coordinate(random)}, 0) != kNoVertex;
  CHECK(inserted > 2500);
  for (int32_t x = -9990; x < 10000; x += 37) {
    for (int32_t depth = 1; depth < 20; depth += 6) mesh.insert({x, 9600 + depth}, 0);
  }
  checkTopology(mesh, loop);
}

TEST_CASE("A triangle with vertices along one side") {
  const std::vector<PlanarPoint> loop{{0, 0}, {1, 0}, {2, 0}, {3, 0}, {10, 0}, {0, 10}};
  Triangulation mesh;
  REQUIRE(mesh.reset(loop));
  checkTopology(mesh, loop);
}
