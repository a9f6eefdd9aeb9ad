#include "bake/bake_plan.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "bake/tile_painter.h"

namespace eye {

namespace {

constexpr double kThreeArcSecondsDeg = 3.0 / 3600;
// Half a post: the palette's slopes and borders have that much detail between posts, finer texels would only blur it.
constexpr double kPaletteDetailPosts = 0.5;
// Texels up to so many times the source's detail are as good as it, at a quarter of the bytes of the next level.
constexpr double kTexelSlack = 1.4;

// Tiles without data of their own are refined beside it up to so many levels above the finest.
constexpr int kNoFinerBesideData = 3;
// The palette draws nothing sharper than two of its finest texels: its texels may be twice as large on screen.
constexpr double kPaletteTexelWeight = 0.5;

// A chunk is drawn where its parent's error is too large at its nearest point, so it is finer than needed at its far
// end, the more so the larger it is for its error, and small ones cost draws. Near the leaves a cell is 610 times its
// error; further up, where a view shows most of its triangles, the ratio falls to 305. Leaves may be finer: few are
// drawn.
constexpr double kCellHeightPerError = 610, kLeastCellHeightPerError = 305;
constexpr double kFallPerLevel = 2.0 / 2.25;  // errors grow by 2.25 a level until the least ratio is reached
constexpr double kQuarterMeridianM = 10001966.0;

double thriftyErrorM(int level, int meshLevel) {
  const double ratio = kCellHeightPerError * std::pow(kFallPerLevel, std::max(0, meshLevel - 1 - level));
  return kQuarterMeridianM * std::exp2(-level) / std::max(ratio, kLeastCellHeightPerError);
}

double cellHeightDeg(int level) {
  return 90 / std::exp2(level);
}

int naturalLevel(double spacingDeg) {
  int level = 0;
  while (level < kMaxLevel && cellHeightDeg(level) > kLeafPosts * spacingDeg) ++level;
  return level;
}

// Cut short at a coarser level it is as exact there as an uncut bake would be.
SourceDetail sourceDetail(double spacingDeg, int maxLevel) {
  const int leafLevel = naturalLevel(spacingDeg), meshLevel = std::min(leafLevel, maxLevel);
  const double leafErrorM = kFinestErrorM * std::max(1.0, spacingDeg / kThreeArcSecondsDeg);
  return {spacingDeg, meshLevel,
          meshLevel < leafLevel ? std::max(leafErrorM, thriftyErrorM(meshLevel, leafLevel)) : leafErrorM};
}

bool meets(const TileBounds& a, const TileBounds& b) {
  return a.southDeg < b.northDeg && b.southDeg < a.northDeg && a.westDeg < b.eastDeg && b.westDeg < a.eastDeg;
}

// By the same ground distance to all sides; in two parts across the date line, and all round beyond a pole.
std::vector<TileBounds> grown(const TileBounds& b, double byDeg) {
  const double highestLatDeg = std::min(89.0, std::max(std::abs(b.southDeg), std::abs(b.northDeg)));
  const double byLonDeg = byDeg / std::cos(radFromDeg(highestLatDeg));
  const double south = b.southDeg - byDeg, north = b.northDeg + byDeg;
  const double west = b.westDeg - byLonDeg, east = b.eastDeg + byLonDeg;
  const auto between = [&](double westDeg, double eastDeg) {
    return TileBounds{std::max(-90.0, south), std::min(90.0, north), westDeg, eastDeg};
  };
  if (south < -90 || north > 90 || east - west >= 360) return {between(-180, 180)};
  if (west < -180) return {between(-180, east), between(west + 360, 180)};
  if (east > 180) return {between(west, 180), between(-180, east - 360)};
  return {between(west, east)};
}

// Post spacing of the finest source that meets any of the regions, degrees; 0 where none does.
double finestSpacingOfAny(const ElevationSurface& surface, const std::vector<TileBounds>& regions) {
  double finestDeg = 0;
  for (const TileBounds& region : regions) {
    const double spacingDeg = surface.finestSpacingDeg(region);
    if (spacingDeg > 0 && (finestDeg == 0 || spacingDeg < finestDeg)) finestDeg = spacingDeg;
  }
  return finestDeg;
}

// Size of the finest detail that pictures in the region can show, degrees; 0 where there is none to show.
double pictureDetailDeg(const BakePlan& plan, const TileBounds& region) {
  const double paletteDeg = plan.surface->finestSpacingDeg(region) * kPaletteDetailPosts;
  const double pixelDeg = plan.imagery != nullptr ? plan.imagery->finestPixelDeg(region) : 0;
  if (paletteDeg == 0 || pixelDeg == 0) return std::max(paletteDeg, pixelDeg);
  return std::min(paletteDeg, pixelDeg);
}

bool isFinerThanTexels(const BakePlan& plan, const TileBounds& region, int level) {
  const double detailDeg = pictureDetailDeg(plan, region);
  return detailDeg > 0 && texelDeg(level, plan.textureSize) > kTexelSlack * detailDeg;
}

}  // namespace

double SourceDetail::toleranceM(int level) const {
  if (level >= meshLevel) return finestErrorM;
  return std::max(finestErrorM * std::exp2(meshLevel - level), thriftyErrorM(level, meshLevel));
}

const SourceDetail& BakePlan::sourceOf(double spacingDeg) const {
  const auto at = std::ranges::find_if(sources, [&](const SourceDetail& s) { return s.spacingDeg >= spacingDeg; });
  return at == sources.end() ? sources.back() : *at;
}

double BakePlan::toleranceM(const TileKey& key) const {
  double leastM = finest().toleranceM(key.level());
  for (std::optional<TileKey> tile = key; tile; tile = tile->parent()) {
    const int level = tile->level();
    const auto isLess = [&](const SourceDetail& source) { return source.toleranceM(level) < leastM; };
    if (std::ranges::none_of(sources, isLess)) continue;  // spares a look at the sources at fine levels
    for (const double spacingDeg : surface->spacingsDeg(tile->bounds()))
      leastM = std::min(leastM, sourceOf(spacingDeg).toleranceM(level));
  }
  return leastM;
}

bool BakePlan::wantsFinerImagery(const TileKey& key) const {
  return key.level() < maxLevel && isFinerThanTexels(*this, key.bounds(), key.level());
}

bool BakePlan::hasImagery(const TileKey& key) const {
  const std::optional<TileKey> parent = key.parent();
  if (!parent || key.isPolar() || parent->isPolar()) return true;
  return isFinerThanTexels(*this, key.bounds(), parent->level());
}

// Also beside finer data, within the cell's own size of it: the further off, the coarser, so that from within the data
// nothing beyond its border is wrong by more pixels than what is inside.
bool BakePlan::wantsChildren(const TileKey& key, double geometricErrorM) const {
  if (key.level() >= maxLevel) return false;
  std::vector<TileBounds> near{key.bounds()};
  if (key.level() < finest().meshLevel - kNoFinerBesideData) {
    const std::vector<TileBounds> around = grown(key.bounds(), cellHeightDeg(key.level()));
    const double besideDeg = finestSpacingOfAny(*surface, around);
    if (besideDeg > 0 && key.level() < sourceOf(besideDeg).meshLevel - kNoFinerBesideData) near = around;
  }
  if (region && std::ranges::none_of(near, [&](const TileBounds& part) { return meets(*region, part); })) return false;
  if (wantsFinerImagery(key) && (!region || meets(*region, key.bounds()))) return true;
  const double spacingDeg = finestSpacingOfAny(*surface, near);
  if (spacingDeg == 0) return false;
  const SourceDetail& source = sourceOf(spacingDeg);
  return key.level() < source.meshLevel && geometricErrorM > source.finestErrorM;
}

double BakePlan::texelErrorM(const TileKey& key) const {
  const bool refines = wantsFinerImagery(key) && (!region || meets(*region, key.bounds()));
  if (!refines) return 0;
  const double pixelDeg = imagery != nullptr ? imagery->finestPixelDeg(key.bounds()) : 0;
  const bool fromImagery = pixelDeg > 0 && texelDeg(key.level(), textureSize) > kTexelSlack * pixelDeg;
  return texelM(key.level(), textureSize) * (fromImagery ? 1.0 : kPaletteTexelWeight);
}

BakePlan makePlan(const ElevationSurface& surface, const ImageryMosaic* imagery, std::vector<double> spacingsDeg,
                  const PlanOptions& options) {
  BakePlan plan;
  plan.surface = &surface;
  plan.imagery = imagery;
  plan.textureSize = options.textureSize;
  plan.region = options.region;
  plan.shard = options.shard;
  std::ranges::sort(spacingsDeg);
  spacingsDeg.erase(std::unique(spacingsDeg.begin(), spacingsDeg.end()), spacingsDeg.end());
  int pictureLevel = 0;
  const double pixelDeg = imagery != nullptr ? imagery->finestPixelDeg({-90, 90, -180, 180}) : 0;
  while (pixelDeg > 0 && pictureLevel < kMaxLevel &&
         texelDeg(pictureLevel, plan.textureSize) > kTexelSlack * pixelDeg) {
    ++pictureLevel;
  }
  const int finestLevel = std::max(naturalLevel(spacingsDeg.front()), pictureLevel);
  plan.maxLevel = std::min(options.maxLevel.value_or(finestLevel), kMaxLevel);
  for (const double spacingDeg : spacingsDeg) plan.sources.push_back(sourceDetail(spacingDeg, plan.maxLevel));
  if (options.errorM) {
    const double finestDeg = plan.finest().spacingDeg;
    for (SourceDetail& source : plan.sources) {
      const bool isCoarse = source.spacingDeg > std::max(finestDeg, kThreeArcSecondsDeg);
      source.finestErrorM = isCoarse ? std::max(source.finestErrorM, *options.errorM) : *options.errorM;
    }
  }
  return plan;
}

}  // namespace eye
