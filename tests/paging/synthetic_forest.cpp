#include "paging/synthetic_forest.h"

#include <sqlite3.h>
#include <unistd.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <random>

#include "terrain/clusters.h"

namespace eye {
namespace {

constexpr int kEdges = 6;  // of the mesh along a side

// Cesium's horizon point: in scaled space along the direction of the chunk's middle, as far as its highest vertex
// needs.
Vec3d horizonPoint(const std::vector<Vec3d>& verticesEcefM, const Vec3d& middleEcefM) {
  const Vec3d axes(kSemiMajorM, kSemiMajorM, kSemiMinorM);
  const Vec3d direction = glm::normalize(middleEcefM / axes);
  double length = 1;
  for (const Vec3d& vertex : verticesEcefM) {
    const Vec3d scaled = vertex / axes;
    const double r = std::max(1.0, glm::length(scaled));
    const double angle = std::acos(std::min(1.0, glm::dot(glm::normalize(scaled), direction))) + std::acos(1 / r);
    if (angle > 1.5) return Vec3d(0);  // no one point stands for it
    length = std::max(length, 1 / std::cos(angle));
  }
  return direction * length;
}

OrientedBox boxAround(const std::vector<Vec3d>& points, const LatLon& middle) {
  const Mat3d axes = ecefFromEnu(middle.latDeg, middle.lonDeg);
  Vec3d low(1e12), high(-1e12);
  for (const Vec3d& p : points) {
    const Vec3d along = glm::transpose(axes) * p;
    low = glm::min(low, along);
    high = glm::max(high, along);
  }
  OrientedBox box;
  box.centreEcefM = axes * ((low + high) * 0.5);
  for (int i = 0; i < 3; ++i) box.halfAxesEcefM[static_cast<size_t>(i)] = axes[i] * ((high[i] - low[i]) * 0.5 + 0.01);
  return box;
}

}  // namespace

double forestHeightM(double latDeg, double lonDeg) {
  const double lat = radFromDeg(latDeg), lon = radFromDeg(lonDeg);
  return 800 * (1 + std::sin(8 * lat) * std::cos(6 * lon) * std::cos(lat));
}

// The sag of level 0 is 54 km over a sixth of 90 degrees; it falls to a quarter with each level.
double forestErrorM(int level) {
  return std::ldexp(80e3, -level);
}

ForestChunk makeForestChunk(const TileKey& key, bool isRefined, bool hasImagery) {
  ForestChunk chunk;
  ChunkMeta& meta = chunk.meta;
  meta.key = key;
  meta.geometricErrorM = forestErrorM(key.level());
  meta.childCount = isRefined ? static_cast<uint8_t>(key.children().count) : uint8_t{0};
  meta.hasImagery = hasImagery;
  const TileBounds b = key.bounds();
  const LatLon middle{(b.southDeg + b.northDeg) / 2, (b.westDeg + b.eastDeg) / 2};
  const double stepM = meta.stepM();
  meta.originLattice = latticeFromEcef(ecefFromGeodetic({middle.latDeg, middle.lonDeg, 0}), stepM);
  meta.minHeightM = 1e9;
  meta.maxHeightM = -1e9;
  const auto add = [&](double east, double north) {
    const Geodetic g{std::lerp(b.southDeg, b.northDeg, north), std::lerp(b.westDeg, b.eastDeg, east), 0};
    const double heightM = forestHeightM(g.latDeg, g.lonDeg);
    const LatticePoint p = latticeFromEcef(ecefFromGeodetic({g.latDeg, g.lonDeg, heightM}), stepM) - meta.originLattice;
    EYE_CHECK(glm::all(glm::lessThanEqual(glm::abs(p), LatticePoint(32767))));
    ChunkVertex& v = chunk.mesh.vertices.emplace_back();
    v = {static_cast<int16_t>(p.x), static_cast<int16_t>(p.y), static_cast<int16_t>(p.z), 0, 0, 0, 0, 0};
    chunk.verticesEcefM.push_back(ecefFromLattice(meta.originLattice + p, stepM));
    meta.minHeightM = std::min(meta.minHeightM, heightM - stepM);
    meta.maxHeightM = std::max(meta.maxHeightM, heightM + stepM);
  };
  const Side poleward = key.isSouthern() ? Side::south : Side::north;
  for (size_t s = 0; s < kSides.size(); ++s) {
    if (key.isPolar() && kSides[s] == poleward) continue;
    chunk.mesh.boundary[s] = kEdges;
    for (int i = 0; i < kEdges; ++i) {
      const double along = static_cast<double>(i) / kEdges;
      if (kSides[s] == Side::south) add(along, 0);
      if (kSides[s] == Side::east) add(1, along);
      if (kSides[s] == Side::north) add(1 - along, 1);
      if (kSides[s] == Side::west) add(0, 1 - along);
    }
  }
  const auto loop = static_cast<uint16_t>(chunk.mesh.vertices.size());
  for (uint16_t i = 0; i < loop; ++i) {
    const auto next = static_cast<uint16_t>((i + 1) % loop);
    chunk.mesh.indices.insert(chunk.mesh.indices.end(), {i, next, loop});
  }
  add(0.5, 0.5);
  for (int i = 1; i < kEdges; ++i) {
    for (int j = 1; j < kEdges; ++j) add(static_cast<double>(i) / kEdges, static_cast<double>(j) / kEdges);
  }
  meta.box = boxAround(chunk.verticesEcefM, middle);
  meta.sphereCentreEcefM = meta.box.centreEcefM;
  for (const Vec3d& v : chunk.verticesEcefM)
    meta.sphereRadiusM = std::max(meta.sphereRadiusM, glm::distance(v, meta.sphereCentreEcefM) + 0.01);
  meta.horizonPointScaled = horizonPoint(chunk.verticesEcefM, meta.box.centreEcefM);
  buildClusters(placeOf(meta), chunk.mesh);
  return chunk;
}

IsRefined everywhereTo(int level) {
  return [level](const TileKey& key) { return key.level() < level; };
}

IsRefined around(double latDeg, double lonDeg, int globalLevel, int level) {
  return [=](const TileKey& key) {
    if (key.level() < globalLevel) return true;
    const TileBounds b = key.bounds();
    const double nearDeg = b.northDeg - b.southDeg;
    return key.level() < level && latDeg > b.southDeg - nearDeg && latDeg < b.northDeg + nearDeg &&
           lonDeg > b.westDeg - nearDeg && lonDeg < b.eastDeg + nearDeg;
  };
}

bool ownImagery(const TileKey& key) {
  const std::optional<TileKey> parent = key.parent();
  return key.level() <= 4 || key.isPolar() || parent->isPolar();
}

TerrainCache makeForest(const IsRefined& isRefined, const IsRefined& isResident) {
  TerrainCache cache;
  const auto resident = [&](const TileKey& key) {
    ResidentChunk chunk;
    chunk.meta = makeForestChunk(key, isRefined(key), ownImagery(key)).meta;
    return chunk;
  };
  std::vector<ResidentChunk> chunks;
  for (int octant = 0; octant < kOctants; ++octant) chunks.push_back(resident(TileKey::octantRoot(octant)));
  cache.insertRoots(chunks);
  std::vector<uint32_t> open(cache.roots().begin(), cache.roots().end());
  while (!open.empty()) {
    const uint32_t parent = open.back();
    open.pop_back();
    const TileKey key = cache.node(parent).meta.key;
    if (!isRefined(key) || !isResident(key)) continue;
    chunks.clear();
    for (const TileKey& child : key.children()) chunks.push_back(resident(child));
    cache.insertChildren(parent, chunks);
    for (uint32_t i = 0; i < chunks.size(); ++i) open.push_back(cache.node(parent).firstChild + i);
  }
  return cache;
}

ForestFile::ForestFile(const IsRefined& isRefined) {
  static std::atomic<int> number = 0;
  const auto name = "eyepoint_forest_" + std::to_string(getpid()) + "_" + std::to_string(number++) + ".eyt";
  path_ = std::filesystem::temp_directory_path() / name;
  std::filesystem::remove(path_);
  DatabaseInfo info;
  info.maxLevel = 10;
  info.finestErrorM = forestErrorM(info.maxLevel);
  info.textureSize = kForestTextureSize;
  info.dataBounds = {-90, 90, -180, 180};
  info.description = "made up";
  const auto must = [](const Result<void>& result) {
    INFO((result ? std::string() : result.error().message));
    REQUIRE(result.has_value());
  };
  Result<DatabaseWriter> writer = DatabaseWriter::create(path_, info);
  INFO((writer ? std::string() : writer.error().message));
  REQUIRE(writer.has_value());
  must(writer->begin());
  const std::vector<uint8_t> rgb(size_t{3} * kForestTextureSize * kForestTextureSize, uint8_t{99});
  const Blob imagery = encodeImagery(rgb, kForestTextureSize);
  std::vector<TileKey> open;
  for (int octant = 0; octant < kOctants; ++octant) open.push_back(TileKey::octantRoot(octant));
  while (!open.empty()) {
    const TileKey key = open.back();
    open.pop_back();
    const ForestChunk chunk = makeForestChunk(key, isRefined(key), ownImagery(key));
    must(writer->putChunk({chunk.meta, encodeMesh(chunk.mesh), ownImagery(key) ? imagery : Blob()}));
    if (!isRefined(key)) continue;
    for (const TileKey& child : key.children()) open.push_back(child);
  }
  must(writer->commit());
  must(writer->finish());
}

ForestFile::~ForestFile() {
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

void ForestFile::damage(const TileKey& key) const {
  sqlite3* database = nullptr;
  REQUIRE(sqlite3_open(path_.c_str(), &database) == SQLITE_OK);
  const std::string flip =
      "UPDATE chunk_data SET mesh = CAST(substr(mesh, 1, 40) || x'A55A' || substr(mesh, 43) AS BLOB) "
      "WHERE code = " +
      std::to_string(static_cast<int64_t>(key.code()));
  CHECK(sqlite3_exec(database, flip.c_str(), nullptr, nullptr, nullptr) == SQLITE_OK);
  CHECK(sqlite3_changes(database) == 1);
  sqlite3_close(database);
}

View randomView(uint32_t seed) {
  std::mt19937 random(seed);
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  Pose pose;
  pose.position.latDeg = degFromRad(std::asin(uniform(-1, 1)));
  pose.position.lonDeg = uniform(-180, 180);
  const double groundM = forestHeightM(pose.position.latDeg, pose.position.lonDeg);
  pose.position.altM = groundM + std::pow(10.0, seed % 4 == 0 ? uniform(1, 7.8) : uniform(1, 4.5));
  pose.headingDeg = uniform(0, 360);
  pose.pitchDeg = uniform(-90, 20);
  pose.rollDeg = uniform(-60, 60);
  const Frustum frustum = seed % 3 == 0 ? offAxisFrustum(uniform(-60, -5), uniform(5, 60), -20, 10, 1)
                                        : symmetricFrustum(uniform(20, 100), 800, 600, 1);
  return makeView(pose, frustum, 800, 600);
}

}  // namespace eye
