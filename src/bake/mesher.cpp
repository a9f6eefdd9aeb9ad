#include "bake/mesher.h"

#include <algorithm>
#include <cmath>

#include "bake/mesh_bounds.h"
#include "bake/mesh_refine.h"
#include "bake/surface_normal.h"
#include "terrain/clusters.h"

namespace eye {
namespace {

// Posts in a tile up to which all of them take part in the greedy phase; above it a regular part of them does, and the
// rest is measured block by block.
constexpr double kMaxGreedyPosts = 131072;
constexpr double kBlockSide = 256;
constexpr int kMaxRounds = 24;  // of measuring all blocks; each but the last inserts
// The greedy phase over a part of the posts aims lower, so that few rounds over all of them follow.
constexpr double kGreedyShare = 0.8;
// Of the tolerance: how far the Earth may bend between samples.
constexpr double kBendShare = 1.0 / 16.0;
// A cell whose centre may be so far, in tolerances, from any two triangles through its corners has it sampled too.
constexpr double kTwistShare = 0.25;
// Normals span this part of a cell's height to either side: about a triangle.
constexpr double kNormalReachShare = 1.0 / 64.0;
constexpr double kQuarterMeridianM = 10001966.0;

// The tile and the strips beyond its north and south side that its straight edges cross, and its rounded vertices.
TileBounds measuredRegion(const TileKey& key, double toleranceM, double stepM) {
  TileBounds b = key.bounds();
  const double strayM = std::min(0.3 * toleranceM, 0.05 * kQuarterMeridianM) + 2.0 * stepM;
  const double strayDeg = degFromRad(strayM / kSemiMinorM);
  b.southDeg = std::max(b.southDeg - strayDeg, -90.0);
  b.northDeg = std::min(b.northDeg + strayDeg, 90.0);
  return b;
}

// Every `stride`th post, and where the surface is twisted, the centre of the cell.
void addSamples(const TileMesh& mesh, const SampleGrid& grid, size_t stride, double toleranceM, MeshRefiner& refiner) {
  const size_t rows = grid.latDeg.size(), columns = grid.lonDeg.size();
  thread_local std::vector<Meridian> meridians, centres;
  meridians.clear();
  centres.clear();
  for (size_t c = 0; c < columns; ++c) {
    meridians.push_back(meridianAt(grid.lonDeg[c]));
    if (c + 1 < columns) centres.push_back(meridianAt((grid.lonDeg[c] + grid.lonDeg[c + 1]) / 2.0));
  }
  const auto add = [&](LatLon place, const Parallel& parallel, const Meridian& meridian, double heightM) {
    refiner.addSample(place, heightM, planeFromEcef(mesh.frame(), ecefFromGraticule(parallel, meridian, heightM)));
  };
  for (size_t r = 0; r < rows; r += stride) {
    const Parallel parallel = parallelAt(grid.latDeg[r]);
    for (size_t c = 0; c < columns; c += stride) {
      add({grid.latDeg[r], grid.lonDeg[c]}, parallel, meridians[c], grid.at(r, c));
    }
    if (stride > 1 || r + 1 == rows) continue;
    const double centreLat = (grid.latDeg[r] + grid.latDeg[r + 1]) / 2.0;
    const Parallel between = parallelAt(centreLat);
    for (size_t c = 0; c + 1 < columns; ++c) {
      const double sw = grid.at(r, c), se = grid.at(r, c + 1), nw = grid.at(r + 1, c), ne = grid.at(r + 1, c + 1);
      if (std::abs(sw + ne - se - nw) / 4.0 < kTwistShare * toleranceM) continue;
      add({centreLat, (grid.lonDeg[c] + grid.lonDeg[c + 1]) / 2.0}, between, centres[c], (sw + se + nw + ne) / 4.0);
    }
  }
}

// All of a tile's surface in one grid.
double refineWhole(const ElevationSurface& surface, const SampleBlock& block, double toleranceM, TileMesh& mesh,
                   MeshRefiner& refiner) {
  thread_local SampleGrid grid;
  fillGrid(surface, block, kBendShare * toleranceM, grid);
  const double inflation = mesh.frame().inflation, slackM = grid.bendM + 2.0 * mesh.quantumM();
  const double targetM = std::max(toleranceM - slackM, 0.0) / inflation;
  addSamples(mesh, grid, 1, toleranceM, refiner);
  refiner.insertSamples(targetM);
  refiner.insertAlongEdges(grid, targetM);
  return refiner.greatestErrorM() * inflation + slackM;
}

// A coarse tile over more posts than fit one grid.
double refineInBlocks(const ElevationSurface& surface, const std::vector<SampleBlock>& blocks, double posts,
                      double toleranceM, TileMesh& mesh, MeshRefiner& refiner) {
  thread_local SampleGrid grid;
  const size_t stride = static_cast<size_t>(std::ceil(std::sqrt(posts / kMaxGreedyPosts)));
  double bendM = 0;
  for (const SampleBlock& block : blocks) {
    fillGrid(surface, block, kBendShare * toleranceM, grid);
    addSamples(mesh, grid, stride, toleranceM, refiner);
    bendM = std::max(bendM, grid.bendM);
  }
  const double inflation = mesh.frame().inflation, slackM = bendM + 2.0 * mesh.quantumM();
  const double targetM = std::max(toleranceM - slackM, 0.0) / inflation;
  refiner.insertSamples(kGreedyShare * targetM);
  for (int round = 1;; ++round) {
    refiner.beginMeasure();
    for (const SampleBlock& block : blocks) {
      if (!refiner.needsMeasure(block.region)) continue;
      fillGrid(surface, block, kBendShare * toleranceM, grid);
      refiner.measurePart(grid, targetM);
    }
    if (round == kMaxRounds || mesh.isFull() || !refiner.insertMeasured(targetM)) break;
  }
  return refiner.greatestErrorM() * inflation + slackM;
}

double refine(const ElevationSurface& surface, const TileKey& key, double toleranceM, double stepM, TileMesh& mesh) {
  thread_local MeshRefiner refiner;
  refiner.reset(mesh);
  const std::vector<SampleBlock> blocks = planBlocks(surface, measuredRegion(key, toleranceM, stepM), kBlockSide);
  double posts = 0;
  for (const SampleBlock& block : blocks) {
    if (block.spacingDeg == 0) continue;
    posts += (block.region.northDeg - block.region.southDeg) * (block.region.eastDeg - block.region.westDeg) /
             (block.spacingDeg * block.spacingDeg);
  }
  if (blocks.size() == 1) return refineWhole(surface, blocks.front(), toleranceM, mesh, refiner);
  return refineInBlocks(surface, blocks, posts, toleranceM, mesh, refiner);
}

// The vertices' lattice bounds fit 16 bits about their middle.
bool fitsSixteenBits(const std::vector<MeshVertex>& vertices, LatticePoint& origin) {
  LatticePoint low = vertices.front().lattice, high = low;
  for (const MeshVertex& v : vertices) {
    low = glm::min(low, v.lattice);
    high = glm::max(high, v.lattice);
  }
  origin = low + (high - low) / int64_t{2};
  const LatticePoint reach = high - low;
  return std::max({reach.x, reach.y, reach.z}) <= 65533;
}

uint16_t unorm16(double value) {
  return static_cast<uint16_t>(std::lround(std::clamp(value, 0.0, 1.0) * 65535.0));
}
// Ten bits are a tenth of a degree, and the rest as zeros is a byte a vertex less in the blob.
int16_t snorm10in16(float value) {
  return static_cast<int16_t>(64 * std::lround(std::clamp(value, -1.0f, 1.0f) * 511.0f));
}

std::vector<ChunkVertex> packVertices(const ElevationSurface& surface, const TileKey& key, const TileMesh& mesh,
                                      const LatticePoint& origin) {
  thread_local std::vector<LatLon> places;
  thread_local std::vector<Vec3d> normals;
  places.clear();
  for (const MeshVertex& v : mesh.vertices()) places.push_back(v.place);
  surfaceNormals(surface, places, kNormalReachShare * std::ldexp(kQuarterMeridianM, -key.level()), normals);
  std::vector<ChunkVertex> packed;
  packed.reserve(places.size());
  for (size_t i = 0; i < places.size(); ++i) {
    const LatticePoint p = mesh.vertices()[i].lattice - origin;
    const TileParam param = paramFromLatLon(key, places[i]);
    const glm::vec2 normal = octahedralFromNormal(glm::vec3(normals[i]));
    packed.push_back(ChunkVertex{static_cast<int16_t>(p.x), static_cast<int16_t>(p.y), static_cast<int16_t>(p.z), 0,
                                 unorm16(param.s), unorm16(param.t), snorm10in16(normal.x), snorm10in16(normal.y)});
  }
  return packed;
}

void fillIndices(const Triangulation& triangulation, std::vector<uint16_t>& indices) {
  indices.clear();
  for (const Triangulation::Triangle& t : triangulation.triangles()) {
    for (const int32_t v : t.vertex) indices.push_back(static_cast<uint16_t>(v));
  }
}

// Interior vertices in the order of their first use, behind the loop's.
void orderForFetch(size_t loopSize, ChunkMesh& mesh) {
  constexpr uint32_t kUnused = ~uint32_t{0};
  std::vector<uint32_t> newIndex(mesh.vertices.size(), kUnused);
  for (size_t i = 0; i < loopSize; ++i) newIndex[i] = static_cast<uint32_t>(i);
  std::vector<ChunkVertex> vertices(mesh.vertices.begin(),
                                    mesh.vertices.begin() + static_cast<std::ptrdiff_t>(loopSize));
  for (uint16_t& corner : mesh.indices) {
    if (newIndex[corner] == kUnused) {
      newIndex[corner] = static_cast<uint32_t>(vertices.size());
      vertices.push_back(mesh.vertices[corner]);
    }
    corner = static_cast<uint16_t>(newIndex[corner]);
  }
  EYE_CHECK(vertices.size() == mesh.vertices.size());  // a triangulation uses every vertex
  mesh.vertices = std::move(vertices);
}

void fillMeta(const TileKey& key, const TileMesh& mesh, double stepM, ChunkMeta& meta) {
  thread_local std::vector<Vec3d> positions;
  positions.clear();
  meta.minHeightM = meta.maxHeightM = mesh.vertices().front().rounded.altM;
  for (const MeshVertex& v : mesh.vertices()) {
    positions.push_back(ecefFromLattice(v.lattice, stepM));
    meta.minHeightM = std::min(meta.minHeightM, v.rounded.altM);
    meta.maxHeightM = std::max(meta.maxHeightM, v.rounded.altM);
  }
  meta.minHeightM -= meta.geometricErrorM;
  meta.maxHeightM += meta.geometricErrorM;
  setBounds(positions, latLonFromParam(key, TileParam{0.5, 0.5}), meta);
}

}  // namespace

MeshedTile meshTile(const ElevationSurface& surface, const TileKey& key, double toleranceM) {
  return meshTile(surface, key, [toleranceM](const TileKey&) { return toleranceM; });
}

MeshedTile meshTile(const ElevationSurface& surface, const TileKey& key, const TileTolerance& toleranceM) {
  const double ownToleranceM = toleranceM(key);
  thread_local TileMesh mesh;
  const TileFrame frame = makeTileFrame(key);
  MeshedTile tile;
  tile.meta.key = key;
  // A cliff that does not fit the level's lattice gets a coarser one of its own: 8 doublings hold any height on Earth.
  for (uint8_t shift = 0;; ++shift) {
    EYE_CHECK(shift < 32);
    const double stepM = std::ldexp(latticeStepM(key.level()), shift);
    const TileBoundary boundary = makeBoundary(surface, key, toleranceM, stepM);
    mesh.reset(frame, stepM, boundary.loop);
    tile.meta.geometricErrorM = refine(surface, key, ownToleranceM, stepM, mesh);
    if (!fitsSixteenBits(mesh.vertices(), tile.meta.originLattice)) continue;
    tile.meta.latticeShift = shift;
    tile.mesh.boundary = boundary.counts;
    tile.mesh.vertices = packVertices(surface, key, mesh, tile.meta.originLattice);
    fillMeta(key, mesh, stepM, tile.meta);
    fillIndices(mesh.triangulation(), tile.mesh.indices);
    buildClusters(placeOf(tile.meta), tile.mesh);
    orderForFetch(mesh.loopSize(), tile.mesh);
    return tile;
  }
}

}  // namespace eye
