#include "bake/mesh_refine.h"

#include <algorithm>
#include <cmath>

namespace eye {
namespace {

// Samples of a tile: 64 bytes each, so 32 MiB a thread.
constexpr size_t kMaxSamples = 500'000;
// Beyond this latitude bounds of a straight line cannot be told from its ends.
constexpr double kBendsFreelyDeg = 75.0;

size_t at(int32_t index) {
  return static_cast<size_t>(index);
}

double cross(double ax, double ay, double bx, double by) {
  return ax * by - ay * bx;
}

}  // namespace

void MeshRefiner::reset(TileMesh& mesh) {
  mesh_ = &mesh;
  lastTriangle_ = 0;
  samples_.clear();
  queue_.clear();
  work_.assign(mesh_->triangulation().triangles().size(), Work{});
  unmeasured_.clear();
  for (size_t t = 0; t < work_.size(); ++t) unmeasured_.push_back(static_cast<int32_t>(t));
}

void MeshRefiner::addSample(LatLon place, double heightM, const PlanePoint& plane) {
  const int32_t triangle = mesh_->locate(plane.x, plane.y, lastTriangle_);
  if (triangle == kNoTriangle) return;
  lastTriangle_ = triangle;
  samples_.push_back({plane, metresPerZ(mesh_->frame(), plane), place.latDeg, place.lonDeg, heightM, -1, false});
  own(triangle, static_cast<int32_t>(samples_.size() - 1));
}

void MeshRefiner::own(int32_t triangle, int32_t sample) {
  Work& w = work(triangle);
  Sample& s = samples_[at(sample)];
  const double errorM = std::abs(s.plane.z - mesh_->facet(triangle).at(s.plane.x, s.plane.y)) * s.metresPerZ;
  s.next = w.firstSample;
  w.firstSample = sample;
  w.samplesM = std::max(w.samplesM, errorM);
  if (!s.isTried && errorM > w.worstM) {
    w.worstM = errorM;
    w.worstSample = sample;
  }
}

void MeshRefiner::rank(int32_t triangle) {
  const Work& w = work(triangle);
  if (w.worstSample < 0) return;
  queue_.push_back({w.worstM, triangle, w.version});
  std::push_heap(queue_.begin(), queue_.end());
}

// Inserts a vertex and shares out the samples of the triangles that it replaces.
bool MeshRefiner::insert(LatLon place, double heightM, int32_t near) {
  if (!mesh_->insert(place, heightM, near)) return false;
  const Triangulation& triangulation = mesh_->triangulation();
  pool_.clear();
  for (const int32_t t : triangulation.replaced()) {
    for (int32_t s = work(t).firstSample; s >= 0; s = samples_[at(s)].next) pool_.push_back(s);
  }
  const std::vector<int32_t>& created = triangulation.created();
  work_.resize(triangulation.triangles().size());
  for (const int32_t t : created) {
    const uint32_t version = work(t).version + 1;
    work(t) = Work{};
    work(t).version = version;
    unmeasured_.push_back(t);
  }
  // About the new vertex each triangle takes a sector.
  const PlanePoint hub = mesh_->vertices().back().plane;
  const size_t sectors = created.size();
  rim_.resize(sectors + 1);
  for (size_t i = 0; i < sectors; ++i) {
    const int32_t from = triangulation.triangles()[at(created[i])].vertex[0];
    rim_[i] = mesh_->vertices()[at(from)].plane;
  }
  rim_[sectors] = rim_[0];
  for (const int32_t s : pool_) {
    const double x = samples_[at(s)].plane.x - hub.x, y = samples_[at(s)].plane.y - hub.y;
    size_t sector = 0;
    bool isLeft = cross(rim_[0].x - hub.x, rim_[0].y - hub.y, x, y) >= 0.0;
    for (size_t i = 0; i < sectors; ++i) {
      const bool isLeftOfNext = cross(rim_[i + 1].x - hub.x, rim_[i + 1].y - hub.y, x, y) >= 0.0;
      if (isLeft && !isLeftOfNext) {
        sector = i;
        break;
      }
      isLeft = isLeftOfNext;
    }
    own(created[sector], s);
  }
  return true;
}

void MeshRefiner::insertSamples(double toleranceM) {
  queue_.clear();
  for (size_t t = 0; t < work_.size(); ++t) {
    if (work_[t].worstM > toleranceM) queue_.push_back({work_[t].worstM, static_cast<int32_t>(t), work_[t].version});
  }
  std::make_heap(queue_.begin(), queue_.end());
  while (!queue_.empty() && !mesh_->isFull()) {
    std::pop_heap(queue_.begin(), queue_.end());
    const Ranked top = queue_.back();
    queue_.pop_back();
    if (work(top.triangle).version != top.version) continue;
    Sample& sample = samples_[at(work(top.triangle).worstSample)];
    sample.isTried = true;
    if (insert({sample.latDeg, sample.lonDeg}, sample.heightM, top.triangle)) {
      for (const int32_t t : mesh_->triangulation().created()) {
        if (work(t).worstM > toleranceM) rank(t);
      }
      continue;
    }
    // Refused: the triangle's next worst.
    Work& w = work(top.triangle);
    w.worstM = 0;
    w.worstSample = -1;
    pool_.clear();
    for (int32_t s = w.firstSample; s >= 0; s = samples_[at(s)].next) pool_.push_back(s);
    w.firstSample = -1;
    for (const int32_t s : pool_) own(top.triangle, s);
    if (w.worstM > toleranceM) rank(top.triangle);
  }
}

void MeshRefiner::insertAlongEdges(const SampleGrid& grid, double toleranceM) {
  while (!unmeasured_.empty()) {
    while (!unmeasured_.empty()) {
      const int32_t t = unmeasured_.back();
      unmeasured_.pop_back();
      insertOnEdge(grid, t, toleranceM);
    }
    insertSamples(toleranceM);
  }
}

// Measures a triangle's edges and inserts on the worst; true where that replaced the triangle.
bool MeshRefiner::insertOnEdge(const SampleGrid& grid, int32_t triangle, double toleranceM) {
  if (work(triangle).edgeM[0] >= 0.0) return false;
  const Triangulation::Triangle corners = mesh_->triangulation().triangles()[at(triangle)];
  ChordError worst;
  for (size_t i = 0; i < 3; ++i) {
    const int32_t neighbour = corners.neighbour[i];
    const int32_t from = corners.vertex[(i + 1) % 3], to = corners.vertex[(i + 2) % 3];
    if (neighbour != kNoTriangle && work(neighbour).edgeM[0] >= 0.0) {
      const Triangulation::Triangle& other = mesh_->triangulation().triangles()[at(neighbour)];
      const size_t k = other.neighbour[0] == triangle ? 0 : other.neighbour[1] == triangle ? 1 : 2;
      work(triangle).edgeM[i] = work(neighbour).edgeM[k];
      continue;
    }
    ChordError edge;
    findChordError(grid, mesh_->vertices()[at(from)].rounded, mesh_->vertices()[at(to)].rounded, toleranceM, edge);
    work(triangle).edgeM[i] = edge.errorM;
    if (neighbour != kNoTriangle && edge.errorM > worst.errorM) worst = edge;
  }
  return worst.errorM > toleranceM && insert(worst.place, worst.heightM, triangle);
}

// A measured triangle is never touched: an insertion replaces it by others.
void MeshRefiner::beginMeasure() {
  exceeding_.clear();
  reach_.clear();
  const std::vector<Triangulation::Triangle>& triangles = mesh_->triangulation().triangles();
  for (size_t t = 0; t < triangles.size(); ++t) {
    if (work_[t].isMeasured) continue;
    work_[t].edgeM = {0, 0, 0};
    TileBounds b{90, -90, 360, -360};
    double spanDeg = 0;
    for (const int32_t v : triangles[t].vertex) {
      const ChordEnd& p = mesh_->vertices()[at(v)].rounded;
      b = {std::min(b.southDeg, p.latDeg), std::max(b.northDeg, p.latDeg), std::min(b.westDeg, p.lonDeg),
           std::max(b.eastDeg, p.lonDeg)};
      if (std::abs(p.latDeg) > kBendsFreelyDeg) spanDeg = 360.0;
    }
    // Straight sides bulge out of these bounds by less than the span squared, in radians.
    spanDeg = std::max({spanDeg, b.northDeg - b.southDeg, b.eastDeg - b.westDeg});
    const double bulgeDeg = radFromDeg(spanDeg * spanDeg);
    reach_.push_back({b.southDeg - bulgeDeg, b.northDeg + bulgeDeg, b.westDeg - bulgeDeg, b.eastDeg + bulgeDeg});
  }
}

bool MeshRefiner::needsMeasure(const TileBounds& r) const {
  return std::any_of(reach_.begin(), reach_.end(), [&](const TileBounds& b) {
    return b.southDeg <= r.northDeg && b.northDeg >= r.southDeg && b.westDeg <= r.eastDeg && b.eastDeg >= r.westDeg;
  });
}

// Posts over triangles not measured yet; those that exceed the tolerance become samples.
void MeshRefiner::measurePosts(const SampleGrid& grid, double toleranceM) {
  const TileFrame& frame = mesh_->frame();
  meridians_.clear();
  for (const double lonDeg : grid.lonDeg) meridians_.push_back(meridianAt(lonDeg));
  int32_t rowStart = 0;
  for (size_t row = 0; row < grid.latDeg.size(); ++row) {
    const Parallel parallel = parallelAt(grid.latDeg[row]);
    int32_t near = rowStart;
    for (size_t column = 0; column < grid.lonDeg.size(); ++column) {
      const double heightM = grid.at(row, column);
      const PlanePoint p = planeFromEcef(frame, ecefFromGraticule(parallel, meridians_[column], heightM));
      const int32_t triangle = mesh_->locate(p.x, p.y, near);
      if (triangle == kNoTriangle) continue;
      near = triangle;
      if (column == 0) rowStart = triangle;
      Work& w = work(triangle);
      if (w.isMeasured) continue;
      const double errorM = std::abs(p.z - mesh_->facet(triangle).at(p.x, p.y)) * metresPerZ(frame, p);
      w.postsM = std::max(w.postsM, errorM);
      if (errorM <= toleranceM) continue;
      if (samples_.size() >= kMaxSamples) {
        if (errorM > w.unsampled.errorM) w.unsampled = {errorM, {grid.latDeg[row], grid.lonDeg[column]}, heightM};
        continue;
      }
      samples_.push_back({p, metresPerZ(frame, p), grid.latDeg[row], grid.lonDeg[column], heightM, -1, false});
      own(triangle, static_cast<int32_t>(samples_.size() - 1));
    }
  }
}

void MeshRefiner::measureEdge(const SampleGrid& grid, int32_t triangle, size_t side, double toleranceM) {
  const Triangulation::Triangle& corners = mesh_->triangulation().triangles()[at(triangle)];
  ChordError error;
  findChordError(grid, mesh_->vertices()[at(corners.vertex[(side + 1) % 3])].rounded,
                 mesh_->vertices()[at(corners.vertex[(side + 2) % 3])].rounded, toleranceM, error);
  Work& w = work(triangle);
  w.edgeM[side] = std::max(w.edgeM[side], error.errorM);
  // On the border nothing can be inserted.
  if (error.errorM > toleranceM && corners.neighbour[side] != kNoTriangle) {
    exceeding_.push_back({error, triangle, w.version});
  }
}

void MeshRefiner::measurePart(const SampleGrid& grid, double toleranceM) {
  measurePosts(grid, toleranceM);
  const std::vector<Triangulation::Triangle>& triangles = mesh_->triangulation().triangles();
  for (size_t t = 0; t < triangles.size(); ++t) {
    if (work_[t].isMeasured) continue;
    for (size_t i = 0; i < 3; ++i) {
      // Once for both sides, unless the other side is not looked at.
      const int32_t other = triangles[t].neighbour[i];
      if (other > static_cast<int32_t>(t) && !work(other).isMeasured) continue;
      measureEdge(grid, static_cast<int32_t>(t), i, toleranceM);
    }
  }
}

bool MeshRefiner::insertMeasured(double toleranceM) {
  for (size_t t = 0; t < work_.size(); ++t) {
    Work& w = work_[t];
    w.isMeasured = true;
    if (w.unsampled.errorM > 0) exceeding_.push_back({w.unsampled, static_cast<int32_t>(t), w.version});
    w.unsampled = ChordError{};
  }
  const size_t before = mesh_->vertices().size();
  insertSamples(toleranceM);
  std::sort(exceeding_.begin(), exceeding_.end(), [](const Exceeding& a, const Exceeding& b) {
    return a.error.errorM != b.error.errorM ? a.error.errorM > b.error.errorM : a.triangle < b.triangle;
  });
  for (const Exceeding& e : exceeding_) {
    // An insertion close by may have replaced the triangle; the next measure tells whether it was enough.
    if (work(e.triangle).version == e.version) insert(e.error.place, e.error.heightM, e.triangle);
  }
  return mesh_->vertices().size() > before;
}

double MeshRefiner::greatestErrorM() const {
  double greatestM = 0;
  for (const Work& w : work_) {
    greatestM = std::max({greatestM, w.samplesM, w.postsM, w.edgeM[0], w.edgeM[1], w.edgeM[2]});
  }
  return greatestM;
}

}  // namespace eye
