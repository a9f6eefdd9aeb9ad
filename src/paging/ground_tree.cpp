#include "paging/ground_tree.h"

#include <algorithm>
#include <cmath>

namespace eye {
namespace {

constexpr size_t kSurfacesBudgetBytes = 32 << 20;
constexpr size_t kMostNodes = 16'384;  // some 5 MiB; a question adds a few thousand at most
constexpr double kBoxSlackM = 0.01;    // for a box without a height

// As TileKey::containing: cells own their south and west edges, and the pole's cells the pole. Across an edge levels
// may differ, so it must not depend on what was asked before.
bool holds(const TileBounds& bounds, double latDeg, double lonDeg) {
  return latDeg >= bounds.southDeg && (latDeg < bounds.northDeg || bounds.northDeg == 90) && lonDeg >= bounds.westDeg &&
         lonDeg < bounds.eastDeg;
}

// A chunk's bounds are those of its own mesh. What is finer reaches beyond them: up and down by both meshes' errors, of
// which the coarser one's is the greater; sideways where edges are chords of the cell's, by the square of their length.
double reachBeyondM(const ChunkMeta& meta) {
  constexpr double kSideways = 4;  // of a chord's height on the Earth; the parallels' edges bend more, up to 80 degrees
  return 2 * meta.geometricErrorM + kSideways * meta.sphereRadiusM * meta.sphereRadiusM / kMeanEarthRadiusM;
}

}  // namespace

Result<void> GroundTree::add(const TileKey& key) {
  const Result<ChunkMeta> meta = reader_.readMeta(key);
  if (!meta) return tl::unexpected(meta.error());
  Node node;
  node.key = key;
  node.bounds = key.bounds();
  node.sphereCentreEcefM = meta->sphereCentreEcefM;
  node.isLeaf = meta->childCount == 0;
  const double reachM = kBoxSlackM + (node.isLeaf ? 0 : reachBeyondM(*meta));
  node.sphereRadiusM =
      meta->sphereRadiusM + 2 * reachM;  // more than the root of three, of a corner moved along each axis
  node.boxCentreEcefM = meta->box.centreEcefM;
  for (size_t axis = 0; axis < 3; ++axis) {
    const Vec3d& half = meta->box.halfAxesEcefM[axis];
    const double lengthM = glm::length(half);
    if (lengthM > 0) node.boxAxes[axis] = half / lengthM;  // an axis of 0 parts nothing
    node.boxExtentsM[axis] = lengthM + reachM;
  }
  nodes_.push_back(std::move(node));
  return {};
}

Result<void> GroundTree::begin() {
  if (nodes_.size() >= kOctants && nodes_.size() <= kMostNodes) return {};
  nodes_.clear();
  kept_.clear();
  keptBytes_ = 0;
  lastLeaf_ = 0;
  for (int octant = 0; octant < kOctants; ++octant) {
    const Result<void> added = add(TileKey::octantRoot(octant));
    if (!added) return added;
  }
  return {};
}

Result<GroundTree::NodeNumber> GroundTree::childrenOf(NodeNumber number) {
  if (nodes_[number].firstChild != 0) return nodes_[number].firstChild;
  const auto first = static_cast<NodeNumber>(nodes_.size());
  const TileList<4> children = nodes_[number].key.children();
  for (const TileKey& child : children) {
    const Result<void> added = add(child);
    if (added) continue;
    nodes_.resize(first);
    return tl::unexpected(added.error());
  }
  nodes_[number].firstChild = first;
  nodes_[number].childCount = static_cast<uint32_t>(children.count);
  return first;
}

Result<const SurfaceGrid*> GroundTree::surfaceOf(NodeNumber number) {
  Node& node = nodes_[number];
  if (node.kept) {
    if (*node.kept != kept_.begin()) kept_.splice(kept_.begin(), kept_, *node.kept);
    return &(*node.kept)->surface;
  }
  const Result<StoredChunk> stored = reader_.read(node.key);
  if (!stored) return tl::unexpected(stored.error());
  const Result<ChunkMesh> mesh = decodeMesh(stored->mesh, node.key);
  if (!mesh) return tl::unexpected(mesh.error());
  kept_.push_front({number, SurfaceGrid(*mesh, stored->meta)});
  node.kept = kept_.begin();
  keptBytes_ += kept_.front().surface.bytes();
  while (keptBytes_ > kSurfacesBudgetBytes && kept_.size() > 1) {
    keptBytes_ -= kept_.back().surface.bytes();
    nodes_[kept_.back().leaf].kept.reset();
    kept_.pop_back();
  }
  return &kept_.front().surface;
}

Result<GroundTree::NodeNumber> GroundTree::leafAt(double latDeg, double lonDeg) {
  const double lat = std::clamp(latDeg, -90.0, 90.0), turned = std::remainder(lonDeg, 360.0);
  const double lon = turned >= 180 ? -180 : turned;
  if (nodes_[lastLeaf_].isLeaf && holds(nodes_[lastLeaf_].bounds, lat, lon)) return lastLeaf_;
  // Cells split exactly, so one of the children holds it; on a common edge either does.
  const auto within = [&](NodeNumber first, uint32_t count) {
    NodeNumber number = first;
    while (number + 1 < first + count && !holds(nodes_[number].bounds, lat, lon)) ++number;
    return number;
  };
  NodeNumber number = within(0, kOctants);
  while (!nodes_[number].isLeaf) {
    const Result<NodeNumber> first = childrenOf(number);
    if (!first) return first;
    number = within(*first, nodes_[number].childCount);
  }
  return lastLeaf_ = number;
}

}  // namespace eye
