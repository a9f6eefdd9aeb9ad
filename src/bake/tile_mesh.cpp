#include "bake/tile_mesh.h"

#include <algorithm>
#include <cmath>

namespace eye {
namespace {

// Of the plane's grid: half of what the triangulation allows, so that interior points may stand out a little.
constexpr double kGridHalf = 8388608.0;
// Nearer to a pole than this a vertex' latitude and longitude are no linear functions of its displacement by rounding.
constexpr double kNearPoleDeg = 89.9;

size_t at(int32_t index) {
  return static_cast<size_t>(index);
}

}  // namespace

MeshVertex TileMesh::makeVertex(LatLon place, double heightM, const Vec3d& ecefM) const {
  MeshVertex v;
  v.place = place;
  v.lattice = latticeFromEcef(ecefM, stepM_);
  const Vec3d rounded = ecefFromLattice(v.lattice, stepM_);
  v.plane = planeFromEcef(frame_, rounded);
  if (std::abs(place.latDeg) > kNearPoleDeg) {
    const Geodetic g = geodeticFromEcef(rounded);
    v.rounded = ChordEnd{g.latDeg, g.lonDeg - 360.0 * std::round((g.lonDeg - place.lonDeg) / 360.0), g.altM};
    return v;
  }
  const Vec3d shift = rounded - ecefM;
  const Parallel parallel = parallelAt(place.latDeg);
  const Meridian meridian = meridianAt(place.lonDeg);
  const Vec3d up(parallel.cosLat * meridian.cosLon, parallel.cosLat * meridian.sinLon, parallel.sinLat);
  const double eastM = meridian.cosLon * shift.y - meridian.sinLon * shift.x;
  const double northM =
      parallel.cosLat * shift.z - parallel.sinLat * (meridian.cosLon * shift.x + meridian.sinLon * shift.y);
  v.rounded.latDeg = place.latDeg + degFromRad(northM / (meridianRadiusM(parallel.sinLat) + heightM));
  v.rounded.lonDeg = place.lonDeg + degFromRad(eastM / ((parallel.primeVerticalM + heightM) * parallel.cosLat));
  v.rounded.altM = heightM + glm::dot(up, shift);
  return v;
}

PlanarPoint TileMesh::gridPoint(const PlanePoint& p) const {
  const double limit = 2.0 * kGridHalf;
  return PlanarPoint{static_cast<int32_t>(std::lround(std::clamp(p.x * gridPerM_, -limit, limit))),
                     static_cast<int32_t>(std::lround(std::clamp(p.y * gridPerM_, -limit, limit)))};
}

void TileMesh::setFacet(int32_t triangle) {
  if (facets_.size() <= at(triangle)) facets_.resize(at(triangle) + 1);
  const std::array<int32_t, 3>& corners = triangulation_.triangles()[at(triangle)].vertex;
  const PlanePoint& a = vertices_[at(corners[0])].plane;
  const PlanePoint& b = vertices_[at(corners[1])].plane;
  const PlanePoint& c = vertices_[at(corners[2])].plane;
  const double bx = b.x - a.x, by = b.y - a.y, bz = b.z - a.z, cx = c.x - a.x, cy = c.y - a.y, cz = c.z - a.z;
  const double area = bx * cy - by * cx;
  Facet& facet = facets_[at(triangle)];
  facet = Facet{a.x, a.y, a.z, 0.0, 0.0};
  if (area <= 0.0) return;  // thinner than the plane's grid
  facet.slopeX = (bz * cy - by * cz) / area;
  facet.slopeY = (bx * cz - bz * cx) / area;
}

bool TileMesh::reset(const TileFrame& frame, double stepM, const std::vector<EdgePoint>& loop) {
  frame_ = frame;
  stepM_ = stepM;
  vertices_.clear();
  double halfM = 1.0;
  for (const EdgePoint& p : loop) {
    vertices_.push_back(makeVertex(p.place, p.heightM, p.ecefM));
    const PlanePoint& plane = vertices_.back().plane;
    halfM = std::max({halfM, std::abs(plane.x), std::abs(plane.y)});
  }
  gridPerM_ = kGridHalf / halfM;
  loopSize_ = vertices_.size();
  thread_local std::vector<PlanarPoint> polygon;
  polygon.clear();
  for (const MeshVertex& v : vertices_) polygon.push_back(gridPoint(v.plane));
  const bool isSimple = triangulation_.reset(polygon);
  facets_.clear();
  for (size_t t = 0; t < triangulation_.triangles().size(); ++t) setFacet(static_cast<int32_t>(t));
  return isSimple;
}

bool TileMesh::insert(LatLon place, double heightM, int32_t near) {
  if (isFull()) return false;
  const MeshVertex vertex =
      makeVertex(place, heightM, ecefFromGraticule(parallelAt(place.latDeg), meridianAt(place.lonDeg), heightM));
  const int32_t home = locate(vertex.plane.x, vertex.plane.y, near);
  if (home == kNoTriangle) return false;
  // Nearer to another vertex than a lattice step it gains nothing: rounding is the error there.
  for (const int32_t corner : triangulation_.triangles()[at(home)].vertex) {
    const PlanePoint& p = vertices_[at(corner)].plane;
    if (std::hypot(p.x - vertex.plane.x, p.y - vertex.plane.y) < stepM_) return false;
  }
  if (triangulation_.insert(gridPoint(vertex.plane), home) == kNoVertex) return false;
  vertices_.push_back(vertex);
  for (const int32_t t : triangulation_.created()) setFacet(t);
  return true;
}

int32_t TileMesh::locate(double x, double y, int32_t near) const {
  const std::vector<Triangulation::Triangle>& triangles = triangulation_.triangles();
  int32_t t = near, from = kNoTriangle;
  for (size_t steps = 0; steps <= triangles.size(); ++steps) {
    const Triangulation::Triangle& triangle = triangles[at(t)];
    int32_t onward = t;
    for (size_t k = 0; k < 3; ++k) {
      const size_t i = (k + steps) % 3;
      if (triangle.neighbour[i] == from && from != kNoTriangle) continue;
      const PlanePoint& a = vertices_[at(triangle.vertex[(i + 1) % 3])].plane;
      const PlanePoint& b = vertices_[at(triangle.vertex[(i + 2) % 3])].plane;
      if ((b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x) < 0.0) {
        onward = triangle.neighbour[i];
        if (onward != kNoTriangle) break;
      }
    }
    if (onward == t) return t;
    if (onward == kNoTriangle) return kNoTriangle;
    from = t;
    t = onward;
  }
  return kNoTriangle;
}

}  // namespace eye
