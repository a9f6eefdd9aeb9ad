#include "bench/ground_heights.h"

#include <algorithm>

namespace eye {
namespace {

constexpr size_t kTilesKept = 64;

// Shares of the three corners at a point, all not negative inside; a triangle without area holds nothing.
std::array<double, 3> barycentric(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c, const glm::dvec2& p) {
  const auto cross = [](const glm::dvec2& u, const glm::dvec2& v) { return u.x * v.y - u.y * v.x; };
  const double area = cross(b - a, c - a);
  if (area == 0) return {-1, -1, -1};
  const double v = cross(p - a, c - a) / area, w = cross(b - a, p - a) / area;
  return {1 - v - w, v, w};
}

}  // namespace

std::vector<Geodetic> vertexPositions(const ChunkMesh& mesh, const ChunkMeta& meta) {
  std::vector<Geodetic> positions;
  positions.reserve(mesh.vertices.size());
  for (const ChunkVertex& v : mesh.vertices)
    positions.push_back(
        geodeticFromEcef(ecefFromLattice(meta.originLattice + LatticePoint(v.x, v.y, v.z), meta.stepM())));
  return positions;
}

Result<const GroundHeights::Tile*> GroundHeights::finestTile(const LatLon& at, TileKey& key) {
  key = TileKey::containing(at.latDeg, at.lonDeg, 0);
  for (int level = 1;; ++level) {
    if (const auto kept = tiles_.find(key); kept != tiles_.end()) return &kept->second;
    const Result<ChunkMeta> meta = reader_.readMeta(key);
    if (!meta) return tl::unexpected(meta.error());
    if (meta->childCount == 0) break;
    key = TileKey::containing(at.latDeg, at.lonDeg, level);
  }
  const Result<StoredChunk> stored = reader_.read(key);
  if (!stored) return tl::unexpected(stored.error());
  Result<ChunkMesh> mesh = decodeMesh(stored->mesh, key);
  if (!mesh) return tl::unexpected(mesh.error());
  if (tiles_.size() >= kTilesKept) tiles_.clear();
  Tile tile;
  for (const Geodetic& position : vertexPositions(*mesh, stored->meta)) tile.heightsM.push_back(position.altM);
  tile.mesh = std::move(*mesh);
  return &tiles_.emplace(key, std::move(tile)).first->second;
}

Result<double> GroundHeights::heightM(const LatLon& at) {
  TileKey key;
  const Result<const Tile*> found = finestTile(at, key);
  if (!found) return tl::unexpected(found.error());
  const Tile& tile = **found;
  const TileParam param = paramFromLatLon(key, at);
  const glm::dvec2 p = glm::clamp(glm::dvec2(param.s, param.t), 0.0, 1.0) * 65535.0;
  const auto place = [&](uint16_t vertex) {
    return glm::dvec2(tile.mesh.vertices[vertex].s, tile.mesh.vertices[vertex].t);
  };
  // The triangle that holds the point, or (parameters are rounded) comes nearest to holding it.
  double best = -1e9, heightM = 0;
  for (size_t i = 0; i + 2 < tile.mesh.indices.size(); i += 3) {
    const uint16_t* corner = &tile.mesh.indices[i];
    const auto shares = barycentric(place(corner[0]), place(corner[1]), place(corner[2]), p);
    const double inside = std::min({shares[0], shares[1], shares[2]});
    if (inside <= best) continue;
    best = inside;
    heightM = 0;
    for (size_t k = 0; k < 3; ++k) heightM += shares[k] * tile.heightsM[corner[k]];
    if (inside >= 0) break;
  }
  return heightM;
}

}  // namespace eye
