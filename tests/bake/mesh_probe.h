// A second opinion on a meshed tile, from its packed vertices alone: rays against all triangles near them.
#pragma once

#include <optional>
#include <vector>

#include "bake/mesher.h"

namespace eye::test {

std::vector<Vec3d> positionsOf(const MeshedTile& tile);
std::vector<LatticePoint> latticeOf(const MeshedTile& tile);

struct ProbeHit {
  double distanceM;  // along the ellipsoid's normal, from the point up to the mesh
  double spreadM;    // between all triangles that the ray meets: 0 but for rounding where they share an edge
};

class MeshProbe {
 public:
  explicit MeshProbe(const MeshedTile& tile);
  std::optional<ProbeHit> probe(double latDeg, double lonDeg, double heightM) const;

 private:
  size_t binOf(double value, double low, double high) const;
  std::vector<Vec3d> positions_;
  std::vector<uint16_t> indices_;
  double south_, north_, west_, east_;
  std::vector<std::vector<uint32_t>> bins_;  // triangles by latitude and longitude
};

}  // namespace eye::test
