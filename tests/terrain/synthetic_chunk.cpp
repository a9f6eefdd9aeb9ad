#include "synthetic_chunk.h"

#include <cmath>
#include <random>

#include "terrain/clusters.h"

namespace eye {
namespace {

double hillsM(const LatLon& at) {
  return 400.0 + 300.0 * std::sin(at.latDeg * 7.0) * std::cos(at.lonDeg * 5.0);
}

// (s, t) in the order of the vertices, boundary first, and the triangles.
struct Outline {
  std::vector<TileParam> params;
  std::vector<uint16_t> indices;
  std::array<uint16_t, 4> boundary{};
};

Outline gridOutline(int n) {
  Outline out;
  const auto at = [n](int i) { return static_cast<double>(i) / n; };
  std::vector<uint16_t> vertexOf(static_cast<size_t>((n + 1) * (n + 1)));
  const auto slot = [&](int i, int j) -> uint16_t& { return vertexOf[static_cast<size_t>(j * (n + 1) + i)]; };
  const auto add = [&](int i, int j) {
    slot(i, j) = static_cast<uint16_t>(out.params.size());
    out.params.push_back({at(i), at(j)});
  };
  for (int i = 0; i < n; ++i) add(i, 0);
  for (int j = 0; j < n; ++j) add(n, j);
  for (int i = n; i > 0; --i) add(i, n);
  for (int j = n; j > 0; --j) add(0, j);
  for (int j = 1; j < n; ++j) {
    for (int i = 1; i < n; ++i) add(i, j);
  }
  out.boundary.fill(static_cast<uint16_t>(n));
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const uint16_t sw = slot(i, j), se = slot(i + 1, j), ne = slot(i + 1, j + 1), nw = slot(i, j + 1);
      out.indices.insert(out.indices.end(), {sw, se, ne, sw, ne, nw});
    }
  }
  return out;
}

// A quarter disc as a fan about its corner, the pole. The loop begins at the south-west corner in the north, where the
// pole comes after the arc and the eastern side, and at the pole in the south.
Outline fanOutline(int n, bool southern) {
  Outline out;
  const auto arc = [n](int i) {
    const double a = i * 1.5707963267948966 / n;
    return TileParam{std::cos(a), std::sin(a)};
  };
  const uint16_t count = static_cast<uint16_t>(n);
  if (southern) {
    out.params.push_back({0, 0});
    out.boundary = {0, 1, count, 1};
    for (int i = 0; i <= n; ++i) out.params.push_back(arc(i));
  } else {
    out.boundary = {count, 1, 0, 1};
    for (int i = 0; i <= n; ++i) out.params.push_back(arc(i));
    out.params.push_back({0, 0});
  }
  const uint16_t pole = southern ? 0 : static_cast<uint16_t>(n + 1), first = southern ? 1 : 0;
  for (uint16_t i = 0; i < count; ++i) {
    const uint16_t vertex = static_cast<uint16_t>(first + i);
    out.indices.insert(out.indices.end(), {pole, vertex, static_cast<uint16_t>(vertex + 1)});
  }
  return out;
}

void setBounds(const std::vector<Vec3d>& pointsEcefM, const LatLon& middle, ChunkMeta& meta) {
  const Mat3d frame = ecefFromEnu(middle.latDeg, middle.lonDeg);
  Vec3d low(1e9), high(-1e9);  // east, north, up
  for (const Vec3d& point : pointsEcefM) {
    low = glm::min(low, glm::transpose(frame) * point);
    high = glm::max(high, glm::transpose(frame) * point);
  }
  meta.box.centreEcefM = frame * (0.5 * (low + high));
  for (int axis = 0; axis < 3; ++axis) {
    meta.box.halfAxesEcefM[static_cast<size_t>(axis)] = frame[axis] * (0.5 * (high - low)[axis] + 1e-3);
  }
  meta.sphereCentreEcefM = meta.box.centreEcefM;
  meta.sphereRadiusM = 0.5 * glm::length(high - low) + 1e-2;
  meta.horizonPointScaled = 2.0 * meta.box.centreEcefM / Vec3d(kSemiMajorM, kSemiMajorM, kSemiMinorM);
}

}  // namespace

SyntheticMesh syntheticMesh(const TileKey& key, int edges) {
  const Outline outline = key.isPolar() ? fanOutline(edges, key.isSouthern()) : gridOutline(edges);
  const LatLon middle = latLonFromParam(key, {0.5, 0.5});
  SyntheticMesh out;
  ChunkMeta& meta = out.meta;
  meta.key = key;
  meta.geometricErrorM = std::ldexp(1e6, -key.level());
  meta.hasImagery = key.isPolar() || key.parent()->isPolar();
  const double stepM = meta.stepM();
  meta.originLattice = latticeFromEcef(ecefFromGeodetic({middle.latDeg, middle.lonDeg, hillsM(middle)}), stepM);
  meta.minHeightM = 1e9;
  meta.maxHeightM = -1e9;
  std::vector<Vec3d> pointsEcefM;
  for (const TileParam& param : outline.params) {
    const LatLon at = latLonFromParam(key, param);
    const Vec3d up = upAt(at.latDeg, at.lonDeg);
    const LatticePoint lattice = latticeFromEcef(ecefFromGeodetic({at.latDeg, at.lonDeg, hillsM(at)}), stepM);
    const LatticePoint offset = lattice - meta.originLattice;
    EYE_CHECK(std::abs(offset.x) < 32768 && std::abs(offset.y) < 32768 && std::abs(offset.z) < 32768);
    const glm::vec2 normal = 32767.0f * octahedralFromNormal(glm::vec3(up));
    out.mesh.vertices.push_back({static_cast<int16_t>(offset.x), static_cast<int16_t>(offset.y),
                                 static_cast<int16_t>(offset.z), 0, static_cast<uint16_t>(std::lround(65535 * param.s)),
                                 static_cast<uint16_t>(std::lround(65535 * param.t)), static_cast<int16_t>(normal.x),
                                 static_cast<int16_t>(normal.y)});
    pointsEcefM.push_back(ecefFromLattice(lattice, stepM));
    const double heightM = geodeticFromEcef(pointsEcefM.back()).altM;
    meta.minHeightM = std::min(meta.minHeightM, heightM);
    meta.maxHeightM = std::max(meta.maxHeightM, heightM);
  }
  out.mesh.indices = outline.indices;
  out.mesh.boundary = outline.boundary;
  setBounds(pointsEcefM, middle, meta);
  buildClusters(placeOf(meta), out.mesh);
  return out;
}

std::vector<uint8_t> syntheticPicture(int size, uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<uint8_t> rgb;
  for (int j = 0; j < size; ++j) {
    for (int i = 0; i < size; ++i) {
      const double wave = std::sin(i * 0.11 + seed) + std::cos(j * 0.07);
      for (int channel = 0; channel < 3; ++channel) {
        rgb.push_back(
            static_cast<uint8_t>(110 + 25 * channel + static_cast<int>(wave * 25) + static_cast<int>(random() % 5)));
      }
    }
  }
  return rgb;
}

StoredChunk syntheticChunk(const TileKey& key, int textureSize, bool hasImagery) {
  const SyntheticMesh made = syntheticMesh(key, 6);
  StoredChunk chunk{made.meta, encodeMesh(made.mesh), {}};
  chunk.meta.hasImagery = chunk.meta.hasImagery || hasImagery;
  if (chunk.meta.hasImagery) {
    chunk.imagery = encodeImagery(syntheticPicture(textureSize, static_cast<uint32_t>(key.code())), textureSize);
  }
  return chunk;
}

}  // namespace eye
