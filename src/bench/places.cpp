#include "bench/places.h"

#include <algorithm>
#include <cmath>

#include "bench/ground_heights.h"

namespace eye {
namespace {

// Cells of 5 km hold a ridge and its valley; a plain should be one over 20 km.
constexpr int kMountainLevel = 11, kPlainLevel = 9;
// So many tiles of a level are looked at at most: the roughest half and the flattest half of them.
constexpr size_t kMostTiles = 2048;
// Where the sources have nothing, and on the sea, the ground is level.
constexpr double kLandReliefM = 0.5;

// The middle 80 % each way.
TileBounds innerPart(const TileBounds& b) {
  const double latDeg = (b.northDeg - b.southDeg) / 10, lonDeg = (b.eastDeg - b.westDeg) / 10;
  return {b.southDeg + latDeg, b.northDeg - latDeg, b.westDeg + lonDeg, b.eastDeg - lonDeg};
}

bool meets(const TileBounds& a, const TileBounds& b) {
  return a.southDeg < b.northDeg && b.southDeg < a.northDeg && a.westDeg < b.eastDeg && b.westDeg < a.eastDeg;
}

bool holds(const TileBounds& b, double latDeg, double lonDeg) {
  return latDeg >= b.southDeg && latDeg <= b.northDeg && lonDeg >= b.westDeg && lonDeg <= b.eastDeg;
}

bool holdsMiddle(const TileBounds& b, const ChunkMeta& meta) {
  const TileBounds tile = meta.key.bounds();
  return holds(b, (tile.southDeg + tile.northDeg) / 2, (tile.westDeg + tile.eastDeg) / 2);
}

double reliefM(const ChunkMeta& meta) {
  return meta.maxHeightM - meta.minHeightM;
}

// Sorted by relief.
Result<std::vector<ChunkMeta>> childrenOf(const DatabaseReader& reader, const std::vector<ChunkMeta>& parents,
                                          const TileBounds& within) {
  std::vector<ChunkMeta> children;
  for (const ChunkMeta& parent : parents) {
    if (parent.childCount == 0) continue;
    for (const TileKey& key : parent.key.children()) {
      if (!meets(key.bounds(), within)) continue;
      const Result<ChunkMeta> meta = reader.readMeta(key);
      if (!meta) return tl::unexpected(meta.error());
      children.push_back(*meta);
    }
  }
  std::ranges::sort(children, {}, reliefM);
  return children;
}

Result<Place> placeIn(const DatabaseReader& reader, const ChunkMeta& meta, const TileBounds& within, std::string name) {
  const Result<StoredChunk> stored = reader.read(meta.key);
  if (!stored) return tl::unexpected(stored.error());
  const Result<ChunkMesh> mesh = decodeMesh(stored->mesh, meta.key);
  if (!mesh) return tl::unexpected(mesh.error());
  std::vector<Geodetic> vertices = vertexPositions(*mesh, stored->meta);
  const auto isOutside = [&](const Geodetic& g) { return !holds(within, g.latDeg, g.lonDeg); };
  if (!std::ranges::all_of(vertices, isOutside)) std::erase_if(vertices, isOutside);
  std::ranges::stable_sort(vertices, {}, &Geodetic::altM);
  const Geodetic& lowest = vertices.front();
  const Geodetic& highest = vertices.back();
  const auto half = std::ranges::lower_bound(vertices, (lowest.altM + highest.altM) / 2, {}, &Geodetic::altM);

  Place place{.name = std::move(name), .reliefM = reliefM(meta)};
  GroundHeights ground(reader);
  for (size_t i = 0; i < place.spots.size(); ++i) {
    const Geodetic& vertex = i == 0 ? lowest : *half;
    const LatLon at{vertex.latDeg, vertex.lonDeg};
    const Result<double> groundM = ground.heightM(at);  // the finest mesh's, not this one's
    if (!groundM) return tl::unexpected(groundM.error());
    place.spots[i] = {at, *groundM, bearingDeg(at, {highest.latDeg, highest.lonDeg})};
  }
  return place;
}

}  // namespace

double bearingDeg(const LatLon& from, const LatLon& to) {
  const double north = to.latDeg - from.latDeg;
  const double east = (to.lonDeg - from.lonDeg) * std::cos(radFromDeg(from.latDeg));
  const double deg = degFromRad(std::atan2(east, north));
  return deg < 0 ? deg + 360 : deg;
}

Result<std::array<Place, 2>> findPlaces(const DatabaseReader& reader) {
  const TileBounds within = innerPart(reader.info().dataBounds);
  std::vector<ChunkMeta> tiles;
  for (int octant = 0; octant < kOctants; ++octant) {
    const Result<ChunkMeta> meta = reader.readMeta(TileKey::octantRoot(octant));
    if (!meta) return tl::unexpected(meta.error());
    if (meets(meta->key.bounds(), within)) tiles.push_back(*meta);
  }
  if (tiles.empty())
    return fail(ErrorKind::badData, reader.path() + ": says that it has no data; give a database with terrain");

  ChunkMeta plain = tiles.front(), mountains = tiles.front();
  for (int level = 0; level <= kMountainLevel; ++level) {
    // Sorted by relief but for the roots, of which any will do.
    std::vector<ChunkMeta> inside = tiles;
    std::erase_if(inside, [&](const ChunkMeta& meta) { return !holdsMiddle(within, meta); });
    if (inside.empty()) inside = tiles;  // large tiles about a small place
    if (level <= kPlainLevel) {
      const auto land = std::ranges::find_if(inside, [](const ChunkMeta& m) { return reliefM(m) > kLandReliefM; });
      plain = land != inside.end() ? *land : inside.front();
    }
    mountains = inside.back();
    if (tiles.size() > kMostTiles) std::erase_if(tiles, [](const ChunkMeta& m) { return reliefM(m) <= kLandReliefM; });
    if (tiles.size() > kMostTiles)
      tiles.erase(tiles.begin() + kMostTiles / 2, tiles.end() - static_cast<std::ptrdiff_t>(kMostTiles / 2));
    Result<std::vector<ChunkMeta>> children = childrenOf(reader, tiles, within);
    if (!children) return tl::unexpected(children.error());
    if (children->empty()) break;
    tiles = std::move(*children);
  }
  Result<Place> low = placeIn(reader, plain, within, "plain");
  if (!low) return tl::unexpected(low.error());
  Result<Place> high = placeIn(reader, mountains, within, "mountains");
  if (!high) return tl::unexpected(high.error());
  return std::array<Place, 2>{std::move(*low), std::move(*high)};
}

}  // namespace eye
