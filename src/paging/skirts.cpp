#include "paging/skirts.h"

#include <algorithm>

#include "paging/across.h"

namespace eye {

void assignSkirts(const TerrainCache& cache, std::span<DrawnChunk> draws) {
  for (DrawnChunk& draw : draws) {
    const CacheNode& node = cache.node(draw.node);
    const double ownM = node.meta.geometricErrorM;
    for (Side side : kSides) {
      const auto s = static_cast<size_t>(side);
      double otherM = ownM;
      forEachAcross(cache, draw.node, side, [&](uint32_t index) {
        const CacheNode& other = cache.node(index);
        const bool sameLevel = other.meta.key.level() == node.meta.key.level();
        const bool sameLattice = other.meta.latticeShift == 0 && node.meta.latticeShift == 0;
        if (other.visit == Visit::outsideFrustum) return;
        if (other.visit == Visit::drawn && sameLevel && sameLattice) return;
        draw.skirtMask = static_cast<uint8_t>(draw.skirtMask | (1u << s));
        // The walk stopped below the horizon at a node that may be far coarser than what would be drawn there; one
        // level coarser is as much as neighbours differ by.
        const double errorM = other.meta.geometricErrorM;
        otherM = std::max(otherM, other.visit == Visit::belowHorizon ? std::min(errorM, 2 * ownM) : errorM);
      });
      if ((draw.skirtMask & (1u << s)) != 0) draw.skirtDepthM[s] = kSkirtMargin * (ownM + otherM);
    }
  }
}

}  // namespace eye
