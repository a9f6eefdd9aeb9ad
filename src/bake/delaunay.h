// A constrained Delaunay triangulation of a polygon that grows point by point, exact on integer coordinates.
// The polygon's edges stay edges; points go strictly inside. Bowyer (1981), Watson (1981).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace eye {

// |x|, |y| <= 2^24: the predicates are exact in 128 bits.
struct PlanarPoint {
  int32_t x = 0, y = 0;
  bool operator==(const PlanarPoint&) const = default;
};

inline constexpr int32_t kNoTriangle = -1;
inline constexpr int32_t kNoVertex = -1;

// Twice the signed area: > 0 where a, b, c turn counterclockwise.
int64_t orientation(PlanarPoint a, PlanarPoint b, PlanarPoint c);
// > 0 where p lies inside the circle through the counterclockwise triangle a, b, c; exact.
int inCircle(PlanarPoint a, PlanarPoint b, PlanarPoint c, PlanarPoint p);

class Triangulation {
 public:
  struct Triangle {
    std::array<int32_t, 3> vertex;     // counterclockwise
    std::array<int32_t, 3> neighbour;  // [i] across the edge opposite vertex[i]; kNoTriangle across the polygon
  };

  // Starts anew with a simple counterclockwise polygon, whose vertices may be collinear but not all of them.
  // False where it is no such polygon: there is a triangulation then too, but triangles of it may be turned over.
  bool reset(std::span<const PlanarPoint> loop);
  // The new vertex, or kNoVertex where p is outside the polygon, on its edge, or on a vertex. `start`: any triangle,
  // best one near p.
  int32_t insert(PlanarPoint p, int32_t start);
  // After insert: triangles that were replaced, and those that took their place (their indices are reused), in
  // counterclockwise order about the new vertex, which is their vertex[2].
  const std::vector<int32_t>& replaced() const { return cavity_; }
  const std::vector<int32_t>& created() const { return created_; }

  const std::vector<PlanarPoint>& points() const { return points_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }

 private:
  struct BorderEdge {
    int32_t from, to, outside;  // counterclockwise about the cavity
  };
  bool clipEars(std::span<const PlanarPoint> loop);
  void linkNeighbours();
  bool flipToDelaunay();
  bool flip(int32_t triangle, int side);
  int32_t locate(PlanarPoint p, int32_t start) const;
  void growCavity(PlanarPoint p, int32_t start);
  bool cavityIsVisible(PlanarPoint p, int32_t start);
  int32_t fillCavity(PlanarPoint p);

  std::vector<PlanarPoint> points_;
  std::vector<Triangle> triangles_;
  std::vector<int32_t> cavity_, created_;
  std::vector<BorderEdge> border_;
  std::vector<uint32_t> mark_;      // by triangle: stamp_ in the cavity, stamp_ + 1 kept out of it
  std::vector<size_t> borderFrom_;  // by vertex: the edge of border_ that starts there
  uint32_t stamp_ = 0;
};

}  // namespace eye
