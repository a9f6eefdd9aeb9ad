// A mesh under construction: vertices on the lattice, triangulated in the tile's plane.
#pragma once

#include <vector>

#include "bake/chord_error.h"
#include "bake/delaunay.h"
#include "bake/edge_simplify.h"
#include "bake/tile_frame.h"
#include "terrain/chunk.h"

namespace eye {

struct MeshVertex {
  LatLon place;      // as asked for
  ChordEnd rounded;  // as it lies on the lattice
  LatticePoint lattice;
  PlanePoint plane;
};

// The plane of a triangle, z a linear function from its first vertex.
struct Facet {
  double x = 0, y = 0, z = 0, slopeX = 0, slopeY = 0;
  double at(double px, double py) const { return z + slopeX * (px - x) + slopeY * (py - y); }
};

class TileMesh {
 public:
  // Starts anew from the boundary; false where its rounded vertices make no simple polygon.
  bool reset(const TileFrame& frame, double stepM, const std::vector<EdgePoint>& loop);
  // False where there is no room, as inserting at or right beside a vertex or the boundary.
  bool insert(LatLon place, double heightM, int32_t near);
  // The triangle over a point of the plane, kNoTriangle outside the mesh.
  int32_t locate(double x, double y, int32_t near) const;

  const Triangulation& triangulation() const { return triangulation_; }
  const std::vector<MeshVertex>& vertices() const { return vertices_; }
  const Facet& facet(int32_t triangle) const { return facets_[static_cast<size_t>(triangle)]; }
  const TileFrame& frame() const { return frame_; }
  size_t loopSize() const { return loopSize_; }
  // Skirts repeat the boundary's vertices, and 16-bit indices must reach all of them.
  bool isFull() const { return vertices_.size() + loopSize_ >= 65535; }
  // The plane's grid, metres: how far a point may be from where the predicates see it.
  double quantumM() const { return 1.0 / gridPerM_; }

 private:
  MeshVertex makeVertex(LatLon place, double heightM, const Vec3d& ecefM) const;
  PlanarPoint gridPoint(const PlanePoint& p) const;
  void setFacet(int32_t triangle);

  TileFrame frame_;
  double stepM_ = 1, gridPerM_ = 1;
  size_t loopSize_ = 0;
  Triangulation triangulation_;
  std::vector<MeshVertex> vertices_;
  std::vector<Facet> facets_;
};

}  // namespace eye
