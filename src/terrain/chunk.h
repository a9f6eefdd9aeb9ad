// A chunk: one tile's mesh, imagery and bounds. What the bake writes, the database keeps and the renderer draws.
//
// Positions are integers on a lattice in ECEF whose step is a power of two and the same for a whole level. Two
// neighbours of one level therefore hold bit-identical points along their common edge, and a shader that computes
// float(vertex + chunkOrigin - eyeCell) * step gets bit-identical floats: no cracks, however near the eye.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "base/error.h"
#include "geo/frames.h"
#include "terrain/tile_key.h"

namespace eye {

using LatticePoint = glm::i64vec3;

// Metres of the lattice step of a level: 65536 steps hold the cell's diameter and its relief. A chunk with a cliff too
// high for that doubles its own (ChunkMeta::latticeShift) and keeps its skirts.
double latticeStepM(int level);
LatticePoint latticeFromEcef(const Vec3d& ecefM, double stepM);  // nearest
inline Vec3d ecefFromLattice(const LatticePoint& p, double stepM) {
  return Vec3d(p) * stepM;
}

// 16 bytes, the layout of the GPU's vertex buffer.
struct ChunkVertex {
  int16_t x, y, z;           // lattice steps from the chunk's origin, ecef axes
  uint16_t skirtSides;       // 0 for the surface; on a skirt's lower rim, bit (1 << Side) for each side it hangs from
  uint16_t s, t;             // TileParam, 0..65535 = 0..1
  int16_t normalU, normalV;  // octahedral unit normal, ecef, snorm16
  bool operator==(const ChunkVertex&) const = default;
};
static_assert(sizeof(ChunkVertex) == 16);

// A run of a chunk's surface triangles with bounds, for culling. Bounds are quantised outward; terrain/clusters.h makes
// and reads them.
struct ChunkCluster {
  uint32_t firstIndex = 0, indexCount = 0;  // into ChunkMesh::indices; the runs lie behind one another and cover the
                                            // surface
  // 0..65535 over the extent of the chunk's own OrientedBox along its axes: centre + axis * (2 * q / 65535 - 1).
  std::array<uint16_t, 3> boxMin{}, boxMax{};
  // All triangles face away from the eye where dot(c - eye, axis) >= cutoff * |c - eye| + r, with c and r the cluster
  // box's centre and half diagonal, axis = coneAxis / 127 (ecef, unit within rounding), cutoff = coneCutoff / 127. A
  // cluster that never does so has the axis 0 and the cutoff 127, with which the test never holds.
  std::array<int8_t, 3> coneAxis{};
  int8_t coneCutoff = 127;
  bool operator==(const ChunkCluster&) const = default;
};

// Counterclockwise triangles seen from above. The first sum(boundary) vertices are the boundary loop, counterclockwise
// from the cell's south-west corner (in a southern pole cell: the pole), side by side in the order of kSides: a side's
// vertices start at the sum of the counts before it, its last vertex is the next side's first.
struct ChunkMesh {
  std::vector<ChunkVertex> vertices;
  std::vector<uint16_t> indices;
  std::vector<ChunkCluster> clusters;  // of the surface, never of skirts
  // By Side, without each side's last; 0 for a pole cell's poleward side, which is a point.
  std::array<uint16_t, 4> boundary{};
};

struct OrientedBox {
  Vec3d centreEcefM{};
  std::array<Vec3d, 3> halfAxesEcefM{};  // orthogonal, length = half extent
};

struct ChunkMeta {
  TileKey key;
  // Greatest distance along the ellipsoid's normal between the mesh and the source's bilinear surface, metres, with the
  // rounding of positions; never less than a child's.
  double geometricErrorM = 0;
  // Size of an imagery texel in metres where a descendant has finer imagery, else 0: refining for it gains nothing.
  double texelErrorM = 0;
  double minHeightM = 0, maxHeightM = 0;  // of the mesh, geodetic
  Vec3d sphereCentreEcefM{};
  double sphereRadiusM = 0;
  OrientedBox box;
  // Horizon point in scaled space (ecef divided by the semi-axes): when it is below the horizon, so is all of the
  // chunk.
  Vec3d horizonPointScaled{};
  LatticePoint originLattice{};
  uint8_t latticeShift = 0;  // the step is latticeStepM(level) * 2^latticeShift; not 0 only across cliffs
  uint8_t childCount = 0;    // 0 (a leaf) or as many as the key has
  // Else it shows its nearest ancestor's that has. Pole cells and their children always have: a parameter of an
  // ordinary cell is no affine function of a pole cell's.
  bool hasImagery = false;
  double stepM() const;
};

// Vertices and triangles of the skirts, made when a chunk is decoded, never stored: for each side a strip from the
// boundary's vertices to a lower rim whose skirtSides tell the shader how to move it; front-facing from outside. The
// rim has one vertex for each of the loop's (a corner's hangs from both its sides), appended in the loop's order:
// vertices and loop together must not exceed 65535.
struct SkirtRange {
  uint32_t firstIndex = 0, indexCount = 0;
};
std::array<SkirtRange, 4> appendSkirts(ChunkMesh& mesh);  // by Side

glm::vec2 octahedralFromNormal(const glm::vec3& unit);
glm::vec3 normalFromOctahedral(const glm::vec2& octahedral);

}  // namespace eye
