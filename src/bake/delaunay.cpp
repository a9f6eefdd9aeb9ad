#include "bake/delaunay.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace eye {
namespace {

__extension__ using Int128 = __int128;

constexpr size_t next(size_t i) {
  return i == 2 ? 0 : i + 1;
}
constexpr size_t previous(size_t i) {
  return i == 0 ? 2 : i - 1;
}
size_t at(int32_t index) {
  return static_cast<size_t>(index);
}

bool isInClosedTriangle(PlanarPoint a, PlanarPoint b, PlanarPoint c, PlanarPoint p) {
  return orientation(a, b, p) >= 0 && orientation(b, c, p) >= 0 && orientation(c, a, p) >= 0;
}

}  // namespace

int64_t orientation(PlanarPoint a, PlanarPoint b, PlanarPoint c) {
  return (int64_t{b.x} - a.x) * (int64_t{c.y} - a.y) - (int64_t{b.y} - a.y) * (int64_t{c.x} - a.x);
}

int inCircle(PlanarPoint a, PlanarPoint b, PlanarPoint c, PlanarPoint p) {
  const int64_t ax = int64_t{a.x} - p.x, ay = int64_t{a.y} - p.y;
  const int64_t bx = int64_t{b.x} - p.x, by = int64_t{b.y} - p.y;
  const int64_t cx = int64_t{c.x} - p.x, cy = int64_t{c.y} - p.y;
  // Squares and cross products stay below 2^53, so only the three products and their sums round.
  const int64_t a2 = ax * ax + ay * ay, b2 = bx * bx + by * by, c2 = cx * cx + cy * cy;
  const int64_t bc = bx * cy - by * cx, ca = cx * ay - cy * ax, ab = ax * by - ay * bx;
  const double termA = static_cast<double>(a2) * static_cast<double>(bc);
  const double termB = static_cast<double>(b2) * static_cast<double>(ca);
  const double termC = static_cast<double>(c2) * static_cast<double>(ab);
  const double sum = termA + termB + termC;
  const double doubt = 1e-15 * (std::abs(termA) + std::abs(termB) + std::abs(termC));
  if (sum > doubt) return 1;
  if (sum < -doubt) return -1;
  const Int128 exact = Int128{a2} * bc + Int128{b2} * ca + Int128{c2} * ab;
  return exact > 0 ? 1 : exact < 0 ? -1 : 0;
}

bool Triangulation::reset(std::span<const PlanarPoint> loop) {
  EYE_CHECK(loop.size() >= 3);
  points_.assign(loop.begin(), loop.end());
  triangles_.clear();
  const bool isSimple = clipEars(loop);
  linkNeighbours();
  mark_.assign(triangles_.size(), 0);
  borderFrom_.assign(points_.size(), 0);
  stamp_ = 0;
  return flipToDelaunay() && isSimple;
}

// An ear: a corner whose triangle holds no other vertex, not even on its rim, so that no triangle is degenerate.
bool Triangulation::clipEars(std::span<const PlanarPoint> loop) {
  bool isSimple = true;
  std::vector<int32_t> ring(loop.size());
  for (size_t i = 0; i < ring.size(); ++i) ring[i] = static_cast<int32_t>(i);
  size_t corner = 0, failures = 0;
  while (ring.size() > 3) {
    const size_t n = ring.size();
    corner %= n;
    const size_t before = (corner + n - 1) % n, after = (corner + 1) % n;
    const PlanarPoint a = loop[at(ring[before])], b = loop[at(ring[corner])], c = loop[at(ring[after])];
    bool isEar = orientation(a, b, c) > 0;
    for (size_t i = 0; isEar && i < n; ++i) {
      isEar = i == before || i == corner || i == after || !isInClosedTriangle(a, b, c, loop[at(ring[i])]);
    }
    if (!isEar && ++failures <= n) {
      ++corner;
      continue;
    }
    isSimple = isSimple && isEar;
    triangles_.push_back(Triangle{{ring[before], ring[corner], ring[after]}, {}});
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(corner));
    failures = 0;
    ++corner;  // not at the same vertex again, which would make a fan of slivers
  }
  triangles_.push_back(Triangle{{ring[0], ring[1], ring[2]}, {}});
  return isSimple && orientation(loop[at(ring[0])], loop[at(ring[1])], loop[at(ring[2])]) > 0;
}

void Triangulation::linkNeighbours() {
  struct HalfEdge {
    int32_t low, high, triangle, side;
  };
  std::vector<HalfEdge> edges;
  for (size_t t = 0; t < triangles_.size(); ++t) {
    for (size_t i = 0; i < 3; ++i) {
      triangles_[t].neighbour[i] = kNoTriangle;
      const int32_t a = triangles_[t].vertex[next(i)], b = triangles_[t].vertex[previous(i)];
      edges.push_back({std::min(a, b), std::max(a, b), static_cast<int32_t>(t), static_cast<int32_t>(i)});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return a.low != b.low ? a.low < b.low : a.high != b.high ? a.high < b.high : a.triangle < b.triangle;
  });
  for (size_t i = 0; i + 1 < edges.size(); ++i) {
    if (edges[i].low != edges[i + 1].low || edges[i].high != edges[i + 1].high) continue;
    triangles_[at(edges[i].triangle)].neighbour[at(edges[i].side)] = edges[i + 1].triangle;
    triangles_[at(edges[i + 1].triangle)].neighbour[at(edges[i + 1].side)] = edges[i].triangle;
  }
}

// Lawson (1977). False where it gives up, which a valid triangulation never makes it do.
bool Triangulation::flipToDelaunay() {
  std::vector<int32_t> stack(triangles_.size());
  for (size_t t = 0; t < stack.size(); ++t) stack[t] = static_cast<int32_t>(t);
  size_t flips = 0;
  const size_t maxFlips = 4 * points_.size() * points_.size() + 64;
  while (!stack.empty()) {
    const int32_t t = stack.back();
    stack.pop_back();
    for (int side = 0; side < 3; ++side) {
      const int32_t other = triangles_[at(t)].neighbour[at(side)];
      if (!flip(t, side)) continue;
      if (++flips > maxFlips) return false;
      stack.push_back(t);
      stack.push_back(other);
      break;
    }
  }
  return true;
}

// Turns the diagonal of the two triangles across `side` where the other one is Delaunay.
bool Triangulation::flip(int32_t triangle, int side) {
  Triangle& t = triangles_[at(triangle)];
  const size_t i = at(side);
  const int32_t other = t.neighbour[i];
  if (other == kNoTriangle) return false;
  Triangle& o = triangles_[at(other)];
  const size_t j = o.neighbour[0] == triangle ? 0 : o.neighbour[1] == triangle ? 1 : 2;
  const int32_t apex = t.vertex[i], right = t.vertex[next(i)], left = t.vertex[previous(i)], far = o.vertex[j];
  if (inCircle(points_[at(apex)], points_[at(right)], points_[at(left)], points_[at(far)]) <= 0) return false;
  if (orientation(points_[at(apex)], points_[at(right)], points_[at(far)]) <= 0 ||
      orientation(points_[at(apex)], points_[at(far)], points_[at(left)]) <= 0) {
    return false;
  }
  const int32_t rightOfT = t.neighbour[previous(i)], leftOfT = t.neighbour[next(i)];
  const int32_t rightOfO = o.neighbour[next(j)], leftOfO = o.neighbour[previous(j)];
  t = Triangle{{apex, right, far}, {rightOfO, other, rightOfT}};
  o = Triangle{{apex, far, left}, {leftOfO, leftOfT, triangle}};
  const auto relink = [&](int32_t outside, int32_t from, int32_t to) {
    if (outside == kNoTriangle) return;
    for (int32_t& n : triangles_[at(outside)].neighbour) {
      if (n == from) {
        n = to;
        return;
      }
    }
  };
  relink(rightOfO, other, triangle);
  relink(leftOfT, triangle, other);
  return true;
}

// Walks towards p; kNoTriangle where it leaves the polygon.
int32_t Triangulation::locate(PlanarPoint p, int32_t start) const {
  int32_t t = start, from = kNoTriangle;
  for (size_t steps = 0; steps <= triangles_.size(); ++steps) {
    const Triangle& triangle = triangles_[at(t)];
    int32_t onward = t;
    for (size_t k = 0; k < 3; ++k) {
      // Not always the same side first: that is what keeps walks from going round in circles.
      const size_t i = (k + steps) % 3;
      if (triangle.neighbour[i] == from && from != kNoTriangle) continue;
      if (orientation(points_[at(triangle.vertex[next(i)])], points_[at(triangle.vertex[previous(i)])], p) < 0) {
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

int32_t Triangulation::insert(PlanarPoint p, int32_t start) {
  cavity_.clear();
  created_.clear();
  const int32_t home = locate(p, start);
  if (home == kNoTriangle) return kNoVertex;
  const Triangle& triangle = triangles_[at(home)];
  for (size_t i = 0; i < 3; ++i) {
    if (points_[at(triangle.vertex[i])] == p) return kNoVertex;
    if (triangle.neighbour[i] == kNoTriangle &&
        orientation(points_[at(triangle.vertex[next(i)])], points_[at(triangle.vertex[previous(i)])], p) <= 0) {
      return kNoVertex;
    }
  }
  stamp_ += 2;
  growCavity(p, home);
  while (!cavityIsVisible(p, home)) growCavity(p, home);
  if (border_.size() != cavity_.size() + 2) {  // no disc: only where the polygon was not simple
    cavity_.clear();
    return kNoVertex;
  }
  return fillCavity(p);
}

// Triangles reachable from `start` whose circumcircle holds p, and their rim.
void Triangulation::growCavity(PlanarPoint p, int32_t start) {
  for (const int32_t t : cavity_) {
    if (mark_[at(t)] == stamp_) mark_[at(t)] = 0;
  }
  cavity_.assign(1, start);
  border_.clear();
  mark_[at(start)] = stamp_;
  for (size_t head = 0; head < cavity_.size(); ++head) {
    const Triangle& t = triangles_[at(cavity_[head])];
    for (size_t i = 0; i < 3; ++i) {
      const int32_t n = t.neighbour[i];
      if (n != kNoTriangle) {
        if (mark_[at(n)] == stamp_) continue;
        const Triangle& o = triangles_[at(n)];
        if (mark_[at(n)] != stamp_ + 1 &&
            inCircle(points_[at(o.vertex[0])], points_[at(o.vertex[1])], points_[at(o.vertex[2])], p) > 0) {
          mark_[at(n)] = stamp_;
          cavity_.push_back(n);
          continue;
        }
      }
      border_.push_back({t.vertex[next(i)], t.vertex[previous(i)], n});
    }
  }
}

// p must see the whole rim from inside. Behind a reflex corner of the polygon it may not: the triangle there is kept
// out.
bool Triangulation::cavityIsVisible(PlanarPoint p, int32_t start) {
  for (const BorderEdge& edge : border_) {
    if (orientation(points_[at(edge.from)], points_[at(edge.to)], p) > 0) continue;
    for (const int32_t t : cavity_) {
      const Triangle& triangle = triangles_[at(t)];
      for (size_t i = 0; i < 3; ++i) {
        if (t == start || triangle.vertex[next(i)] != edge.from || triangle.vertex[previous(i)] != edge.to) continue;
        mark_[at(t)] = stamp_ + 1;
        return false;
      }
    }
  }
  return true;
}

int32_t Triangulation::fillCavity(PlanarPoint p) {
  const int32_t vertex = static_cast<int32_t>(points_.size());
  points_.push_back(p);
  borderFrom_.push_back(0);
  const size_t count = border_.size();
  for (size_t i = 0; i < count; ++i) {
    borderFrom_[at(border_[i].from)] = i;
    if (i < cavity_.size()) {
      created_.push_back(cavity_[i]);
    } else {
      created_.push_back(static_cast<int32_t>(triangles_.size()));
      triangles_.emplace_back();
      mark_.push_back(0);
    }
  }
  size_t b = 0;
  for (size_t i = 0; i < count; ++i, b = borderFrom_[at(border_[b].to)]) {
    const BorderEdge& edge = border_[b];
    const int32_t t = created_[i];
    triangles_[at(t)] =
        Triangle{{edge.from, edge.to, vertex},
                 {created_[i + 1 == count ? 0 : i + 1], created_[i == 0 ? count - 1 : i - 1], edge.outside}};
    mark_[at(t)] = 0;
    if (edge.outside == kNoTriangle) continue;
    // The outer triangle's edge is known by its vertices: its old neighbour's index is another's by now.
    Triangle& outer = triangles_[at(edge.outside)];
    for (size_t k = 0; k < 3; ++k) {
      if (outer.vertex[next(k)] == edge.to && outer.vertex[previous(k)] == edge.from) outer.neighbour[k] = t;
    }
  }
  return vertex;
}

}  // namespace eye
