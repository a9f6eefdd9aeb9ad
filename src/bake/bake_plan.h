// Which tiles a bake makes, how exact they are and which carry a picture. Pure decisions.
#pragma once

#include <optional>
#include <vector>

#include "bake/elevation.h"
#include "bake/imagery_mosaic.h"
#include "terrain/chunk.h"

namespace eye {

// A leaf spans about so many posts of its source.
inline constexpr int kLeafPosts = 8;
// The leaves' tolerance for 3-arc-second posts and finer ones; coarser posts get proportionally more. From 50 m above a
// valley's floor, 99.998 % of pixels are right with 0.25 m and 99.0 % with 1 m, which is far less than the posts' own
// error.
inline constexpr double kFinestErrorM = 0.25;

// How a source is baked, whatever others there are: the level where its posts end, the tolerance there and above.
struct SourceDetail {
  double spacingDeg = 0;
  int meshLevel = 0;
  double finestErrorM = kFinestErrorM;

  double toleranceM(int level) const;
};

// One of several processes that share a bake, see shard.h.
struct Shard {
  int index = 1, count = 1;  // 1 to count
};

// The sources outlive the plan. Thread: any number at once.
struct BakePlan {
  const ElevationSurface* surface = nullptr;
  const ImageryMosaic* imagery = nullptr;  // may be null
  int textureSize = 256;
  int maxLevel = 0;
  std::vector<SourceDetail> sources;  // the finest first
  std::optional<TileBounds> region;   // refine only what meets it
  std::optional<Shard> shard;         // make only this part

  // The least of those that the sources in the tile, or in one that it descends from, have at that level: a globe is as
  // exact where it is baked alone as where it lies around something finer, and errors fall from parent to child.
  double toleranceM(const TileKey& key) const;
  bool hasImagery(const TileKey& key) const;
  // Whether a child could show finer imagery than the tile.
  bool wantsFinerImagery(const TileKey& key) const;
  bool wantsChildren(const TileKey& key, double geometricErrorM) const;
  double texelErrorM(const TileKey& key) const;

  const SourceDetail& finest() const { return sources.front(); }
  const SourceDetail& sourceOf(double spacingDeg) const;
};

struct PlanOptions {
  int textureSize = 256;
  std::optional<int> maxLevel;
  std::optional<double> errorM;
  std::optional<TileBounds> region;
  std::optional<Shard> shard;
};

// `spacingsDeg`: of all elevation sources, at least one.
BakePlan makePlan(const ElevationSurface& surface, const ImageryMosaic* imagery, std::vector<double> spacingsDeg,
                  const PlanOptions& options);

}  // namespace eye
