#include "bake/bake_estimate.h"

#include <limits>

namespace eye {

namespace {

// So many parents of a level are looked at; beyond, each stands for several.
constexpr size_t kSampledParents = 4096;

}  // namespace

std::vector<double> mostTiles(const BakePlan& plan) {
  std::vector<TileKey> tiles;
  for (int octant = 0; octant < kOctants; ++octant) tiles.push_back(TileKey::octantRoot(octant));
  std::vector<double> counts;
  double weight = 1;  // tiles that each of `tiles` stands for
  while (!tiles.empty()) {
    counts.push_back(weight * static_cast<double>(tiles.size()));
    std::vector<TileKey> parents;
    for (const TileKey& key : tiles) {
      if (plan.wantsChildren(key, std::numeric_limits<double>::infinity())) parents.push_back(key);
    }
    const size_t step = (parents.size() + kSampledParents - 1) / kSampledParents;
    tiles.clear();
    size_t looked = 0;
    for (size_t i = 0; i < parents.size(); i += step) {
      for (const TileKey& child : parents[i].children()) tiles.push_back(child);
      ++looked;
    }
    if (looked > 0) weight *= static_cast<double>(parents.size()) / static_cast<double>(looked);
  }
  return counts;
}

}  // namespace eye
