#include "paging/ground_tree.h"

#include <algorithm>
#include <cmath>

namespace eye {
namespace {

constexpr size_t kSurfacesBudgetBytes = 32 << 20;
constexpr size_t kMostNodes = 16'384;  // some 5 MiB; a question adds a few thousand at most
// Sights are mostly shorter than half of it; one of 10 km round the first of them takes 10 % less time.
constexpr double kBallRadiusM = 64'000;
constexpr std::array<uint32_t, 2> kRoots{0, 1};  // siblings, the octants: begin() adds them first
static_assert(kRoots.size() * SiblingBounds::kLanes == kOctants);
constexpr double kBoxSlackM = 0.01;  // for a box without a height

// As TileKey::containing: cells own their south and west edges, and the pole's cells the pole. Across an edge levels
// may differ, so it must not depend on what was asked before.
bool holds(const TileBounds& bounds, double latDeg, double lonDeg) {
  return latDeg >= bounds.southDeg && (latDeg < bounds.northDeg || bounds.northDeg == 90) && lonDeg >= bounds.westDeg &&
         lonDeg < bounds.eastDeg;
}

// A chunk's bounds are those of its own mesh. What is finer reaches beyond them: up and down by both meshes' errors, of
// which the coarser one's is the greater; and where an edge is a chord of its cell's parallel, sideways by the chord's
// height times the sine of the latitude, with whatever heights are there. A chord's height is at most so much of its
// length's square; and what of it is upwards, its height times the cosine, is at most what ground and error leave it.
double reachBeyondM(const ChunkMeta& meta) {
  constexpr double kSideways = 4;  // of a chord's height on the Earth; the parallels' edges bend more, up to 80 degrees
  const double ofLengthM = kSideways * meta.sphereRadiusM * meta.sphereRadiusM / kMeanEarthRadiusM;
  const TileBounds bounds = meta.key.bounds();
  const double polewardDeg = std::max(std::abs(bounds.southDeg), std::abs(bounds.northDeg));
  const double reliefM = meta.maxHeightM - meta.minHeightM + 2 * meta.geometricErrorM;
  const double ofReliefM = polewardDeg < 90 ? reliefM * (1 + std::tan(glm::radians(polewardDeg))) : ofLengthM;
  return 2 * meta.geometricErrorM + std::min(ofLengthM, ofReliefM);
}

}  // namespace

// Siblings, all of them or none.
Result<void> GroundTree::add(std::span<const TileKey> keys) {
  const auto first = static_cast<NodeNumber>(nodes_.size());
  Siblings siblings{first, static_cast<uint32_t>(keys.size()), {}};
  for (uint32_t lane = 0; lane < siblings.count; ++lane) {
    const TileKey& key = keys[lane];
    const Result<ChunkMeta> meta = reader_.readMeta(key);
    if (!meta) {
      nodes_.resize(first);
      return tl::unexpected(meta.error());
    }
    const bool isLeaf = meta->childCount == 0;
    siblings.bounds.set(lane, meta->box, kBoxSlackM + (isLeaf ? 0 : reachBeyondM(*meta)));
    nodes_.push_back({.bounds = key.bounds(),
                      .key = key,
                      .isLeaf = isLeaf,
                      .errorM = static_cast<float>(meta->geometricErrorM),
                      .kept = {},
                      .children = {}});
  }
  siblings_.push_back(siblings);
  return {};
}

Result<void> GroundTree::begin() {
  if (siblings_.size() >= kRoots.size() && nodes_.size() <= kMostNodes) return {};
  nodes_.clear();
  siblings_.clear();
  ball_.radiusM = -1;
  kept_.clear();
  keptBytes_ = 0;
  lastLeaf_ = 0;
  std::array<TileKey, kOctants> roots;
  for (int octant = 0; octant < kOctants; ++octant) roots[static_cast<size_t>(octant)] = TileKey::octantRoot(octant);
  for (const uint32_t number : kRoots) {
    const Result<void> added = add(std::span(roots).subspan(number * SiblingBounds::kLanes, SiblingBounds::kLanes));
    if (!added) return added;
  }
  return {};
}

Result<std::span<const uint32_t>> GroundTree::ancestorsFor(const Sight& sight) {
  if (glm::length(sight.wayEcefM) > kBallRadiusM) return kRoots;
  // A ball is convex: where it holds both ends, it holds the line.
  const auto holds = [this](const Vec3d& ecefM) { return glm::length(ecefM - ball_.centreEcefM) <= ball_.radiusM; };
  if (!holds(sight.fromEcefM) || !holds(sight.fromEcefM + sight.wayEcefM)) {
    ball_.radiusM = -1;
    const Ball ball{sight.fromEcefM, kBallRadiusM};
    const Result<void> descended = descendTowards(ball);
    if (!descended) return tl::unexpected(descended.error());
    ball_ = ball;
  }
  return ancestors_;
}

// All octants, then level by level what of their children reaches into the ball, while those are few.
Result<void> GroundTree::descendTowards(const Ball& ball) {
  ancestors_.assign(kRoots.begin(), kRoots.end());
  while (true) {
    descendants_.clear();
    for (const uint32_t ancestor : ancestors_) {
      const SiblingBounds::Mask near = siblings_[ancestor].bounds.reachInto(ball);
      const NodeNumber first = siblings_[ancestor].first;
      for (uint32_t lane = 0; lane < siblings_[ancestor].count; ++lane) {
        if (!near[lane]) continue;
        if (nodes_[first + lane].isLeaf || descendants_.size() == kMostAncestors) return {};
        const Result<const Siblings*> children = childrenOf(first + lane);
        if (!children) return tl::unexpected(children.error());
        descendants_.push_back(*nodes_[first + lane].children);
      }
    }
    ancestors_.swap(descendants_);
    if (ancestors_.empty()) return {};  // it touches boxes of inner nodes, and nothing in them
  }
}

Result<const GroundTree::Siblings*> GroundTree::childrenOf(NodeNumber innerNode) {
  if (!nodes_[innerNode].children) {
    const TileList<4> children = nodes_[innerNode].key.children();
    const Result<void> added = add({children.begin(), children.end()});
    if (!added) return tl::unexpected(added.error());
    nodes_[innerNode].children = static_cast<uint32_t>(siblings_.size() - 1);
  }
  return &siblings_[*nodes_[innerNode].children];
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
    const Result<const Siblings*> children = childrenOf(number);
    if (!children) return tl::unexpected(children.error());
    number = within((*children)->first, (*children)->count);
  }
  return lastLeaf_ = number;
}

}  // namespace eye
