#include "paging/ground_query.h"

#include <fmt/format.h>

#include <algorithm>
#include <queue>

namespace eye {
namespace {

constexpr size_t kMeshBudgetBytes = 32 << 20;
constexpr size_t kMostMetas = 16'384;  // some 5 MiB

// Where a line meets a triangle's plane (after Möller and Trumbore 1997).
struct Crossing {
  double along = 0;   // 0 at the line's first point, 1 at its second
  double inside = 0;  // the least of the three corners' shares: negative outside the triangle
};

std::optional<Crossing> crossingOf(const Vec3d& from, const Vec3d& way, const Vec3d& a, const Vec3d& b,
                                   const Vec3d& c) {
  const Vec3d ab = b - a, ac = c - a, p = glm::cross(way, ac);
  const double determinant = glm::dot(ab, p);
  if (determinant == 0) return std::nullopt;
  const Vec3d fromA = from - a, q = glm::cross(fromA, ab);
  const double v = glm::dot(fromA, p) / determinant, w = glm::dot(way, q) / determinant;
  return Crossing{glm::dot(ac, q) / determinant, std::min({1 - v - w, v, w})};
}

// Where a line enters a box, as a share of its way; nothing where it misses it.
std::optional<double> entryOf(const OrientedBox& box, const Vec3d& from, const Vec3d& way) {
  constexpr double kSlackM = 0.01;  // for a box without a height
  double enters = 0, leaves = 1;
  for (const Vec3d& half : box.halfAxesEcefM) {
    const double lengthM = glm::length(half);
    if (lengthM == 0) continue;
    const Vec3d axis = half / lengthM;
    const double at = glm::dot(from - box.centreEcefM, axis), speed = glm::dot(way, axis);
    const double extentM = lengthM + kSlackM;
    if (std::abs(speed) < 1e-12) {
      if (std::abs(at) > extentM) return std::nullopt;
      continue;
    }
    const double first = (-extentM - at) / speed, second = (extentM - at) / speed;
    enters = std::max(enters, std::min(first, second));
    leaves = std::min(leaves, std::max(first, second));
  }
  return enters <= leaves ? std::optional(enters) : std::nullopt;
}

GroundHit hitAt(const Vec3d& ecefM, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  return {geodeticFromEcef(ecefM), glm::normalize(glm::cross(b - a, c - a))};
}

struct Waiting {
  double enters = 0;
  TileKey key;
  bool hasChildren = false;
  bool operator>(const Waiting& other) const { return enters > other.enters; }
};

}  // namespace

Result<GroundQuery> GroundQuery::open(const std::string& databasePath) {
  Result<DatabaseReader> reader = DatabaseReader::open(databasePath);
  if (!reader) return tl::unexpected(reader.error());
  return GroundQuery(std::move(*reader));
}

Result<const ChunkMeta*> GroundQuery::metaOf(const TileKey& key) {
  if (const auto found = metas_.find(key.code()); found != metas_.end()) return &found->second;
  const Result<ChunkMeta> meta = reader_.readMeta(key);
  if (!meta) return tl::unexpected(meta.error());
  if (metas_.size() >= kMostMetas) metas_.clear();
  return &metas_.emplace(key.code(), *meta).first->second;
}

const GroundQuery::Mesh* GroundQuery::keptMeshOf(const TileKey& key) {
  const auto found = meshes_.find(key.code());
  if (found == meshes_.end()) return nullptr;
  uses_.splice(uses_.begin(), uses_, found->second.use);
  return &found->second.mesh;
}

Result<const GroundQuery::Mesh*> GroundQuery::meshOf(const TileKey& key) {
  if (const Mesh* kept = keptMeshOf(key)) return kept;
  const Result<StoredChunk> stored = reader_.read(key);
  if (!stored) return tl::unexpected(stored.error());
  const Result<ChunkMesh> decoded = decodeMesh(stored->mesh, key);
  if (!decoded) return tl::unexpected(decoded.error());
  Mesh mesh;
  const double stepM = stored->meta.stepM();
  mesh.originEcefM = ecefFromLattice(stored->meta.originLattice, stepM);
  mesh.minHeightM = stored->meta.minHeightM, mesh.maxHeightM = stored->meta.maxHeightM;
  // A step is a power of two and a vertex 16 bits, so the float is exact.
  for (const ChunkVertex& v : decoded->vertices)
    mesh.positionsM.push_back(glm::vec3(v.x, v.y, v.z) * static_cast<float>(stepM));
  mesh.grid = TriangleGrid(*decoded);
  mesh.indices = decoded->indices;

  meshBytes_ += mesh.bytes();
  while (meshBytes_ > kMeshBudgetBytes && !uses_.empty()) {
    meshBytes_ -= meshes_.at(uses_.back()).mesh.bytes();
    meshes_.erase(uses_.back());
    uses_.pop_back();
  }
  uses_.push_front(key.code());
  return &meshes_.emplace(key.code(), Kept{std::move(mesh), uses_.begin()}).first->second.mesh;
}

Result<std::pair<TileKey, const GroundQuery::Mesh*>> GroundQuery::leafAt(double latDeg, double lonDeg) {
  // Only leaves are kept, so what is found on any level is the leaf.
  for (const int level : {leafLevel_, leafLevel_ + 1, leafLevel_ - 1}) {
    if (level < 0 || level > kMaxLevel) continue;
    const TileKey key = TileKey::containing(latDeg, lonDeg, level);
    const Mesh* kept = keptMeshOf(key);
    if (kept == nullptr) continue;
    leafLevel_ = level;
    return std::pair(key, kept);
  }
  TileKey key = TileKey::containing(latDeg, lonDeg, 0);
  Result<const ChunkMeta*> meta = metaOf(key);
  while (meta && (*meta)->childCount > 0) {
    key = TileKey::containing(latDeg, lonDeg, key.level() + 1);
    meta = metaOf(key);
  }
  if (!meta) return tl::unexpected(meta.error());
  const Result<const Mesh*> mesh = meshOf(key);
  if (!mesh) return tl::unexpected(mesh.error());
  leafLevel_ = key.level();
  return std::pair(key, *mesh);
}

Result<GroundHit> GroundQuery::under(double latDeg, double lonDeg) {
  const auto leaf = leafAt(latDeg, lonDeg);
  if (!leaf) return tl::unexpected(leaf.error());
  const auto& [key, found] = *leaf;
  const Mesh& mesh = *found;

  // The plumb line, a metre beyond the ground's heights.
  const double topM = mesh.maxHeightM + 1, deepM = topM - (mesh.minHeightM - 1);
  const Vec3d up = upAt(latDeg, lonDeg);
  const Vec3d top = ecefFromGeodetic({latDeg, lonDeg, topM}) - mesh.originEcefM, way = -deepM * up;
  // The triangle that it goes through, or comes nearest to: a chunk's edges are chords of its cell's.
  Crossing best{0, -1e30};
  Vec3d normal{};
  const auto look = [&](size_t i) {
    const Vec3d a(mesh.positionsM[mesh.indices[i]]), b(mesh.positionsM[mesh.indices[i + 1]]),
        c(mesh.positionsM[mesh.indices[i + 2]]);
    const auto crossing = crossingOf(top, way, a, b, c);
    if (crossing && crossing->inside > best.inside) best = *crossing, normal = glm::cross(b - a, c - a);
    return best.inside >= 0;
  };
  const TileParam at = paramFromLatLon(key, {latDeg, lonDeg});
  const bool isInside = std::ranges::any_of(mesh.grid.near(at.s, at.t), look);
  for (size_t i = 0; !isInside && i + 2 < mesh.indices.size(); i += 3)
    if (look(i)) break;
  if (best.inside < -1)
    return fail(ErrorKind::badData, fmt::format("{} has no triangle under {} {}", key.name(), latDeg, lonDeg));
  return GroundHit{{latDeg, lonDeg, topM - deepM * best.along}, glm::normalize(normal)};
}

// Chunks in the order in which the line enters their boxes, parents before children, until the nearest hit comes before
// all that is left.
Result<std::optional<GroundHit>> GroundQuery::between(const Vec3d& fromEcefM, const Vec3d& toEcefM) {
  const Vec3d way = toEcefM - fromEcefM;
  std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>> waiting;
  int looked = 0;
  const auto look = [&](const TileKey& key) -> Result<void> {
    if (++looked > kMostChunks)
      return fail(ErrorKind::unsupported, fmt::format("a line of sight meets more than {} chunks", kMostChunks));
    const Result<const ChunkMeta*> meta = metaOf(key);
    if (!meta) return tl::unexpected(meta.error());
    if (const auto enters = entryOf((*meta)->box, fromEcefM, way))
      waiting.push({*enters, key, (*meta)->childCount > 0});
    return {};
  };
  for (int octant = 0; octant < kOctants; ++octant)
    if (const auto ok = look(TileKey::octantRoot(octant)); !ok) return tl::unexpected(ok.error());

  std::optional<GroundHit> nearest;
  double nearestAlong = 1;
  while (!waiting.empty() && waiting.top().enters <= nearestAlong) {
    const auto [enters, key, hasChildren] = waiting.top();
    waiting.pop();
    if (hasChildren) {
      for (const TileKey& child : key.children())
        if (const auto ok = look(child); !ok) return tl::unexpected(ok.error());
      continue;
    }
    const Result<const Mesh*> mesh = meshOf(key);
    if (!mesh) return tl::unexpected(mesh.error());
    const std::vector<glm::vec3>& positionsM = (*mesh)->positionsM;
    const std::vector<uint16_t>& indices = (*mesh)->indices;
    const Vec3d from = fromEcefM - (*mesh)->originEcefM;
    constexpr double kOnTheEdge = -1e-9;  // a line along an edge meets one of its triangles
    for (size_t i = 0; i + 2 < indices.size(); i += 3) {
      const Vec3d a(positionsM[indices[i]]), b(positionsM[indices[i + 1]]), c(positionsM[indices[i + 2]]);
      const auto crossing = crossingOf(from, way, a, b, c);
      if (!crossing || crossing->inside < kOnTheEdge || crossing->along < 0 || crossing->along > nearestAlong) continue;
      nearestAlong = crossing->along;
      nearest = hitAt(fromEcefM + way * crossing->along, a, b, c);
    }
  }
  return nearest;
}

}  // namespace eye
