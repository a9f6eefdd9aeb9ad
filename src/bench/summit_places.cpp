#include "bench/summit_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>

#include <fmt/format.h>

#include "bench/ground_heights.h"
#include "geo/scene_bend.h"
#include "pano/peaks.h"

namespace eye {
namespace {

constexpr int kSummitLevel = 13;  // cells of 1.2 km
constexpr double kSummitsApartM = 2000, kViewpointsApartM = 40000;
constexpr double kEyeM = 2;
constexpr double kSameSummitM = 300;  // between gazetteer and terrain; else the terrain does not have it

double apartM(double latA, double lonA, double latB, double lonB) {
  return glm::distance(ecefFromGeodetic({latA, lonA, 0}), ecefFromGeodetic({latB, lonB, 0}));
}

// The ground that is nearest to half the height between the lowest around and the summit, of 64 places within 12 km.
Result<Geodetic> halfWayUp(GroundQuery& ground, const Geodetic& summit) {
  std::vector<Geodetic> places;
  for (const double awayM : {3000, 6000, 9000, 12000}) {
    for (int i = 0; i < 16; ++i) {
      const double turn = radFromDeg(22.5 * i);
      const double north = awayM * std::cos(turn), east = awayM * std::sin(turn);
      const auto hit = ground.under(summit.latDeg + north / 111200,
                                    summit.lonDeg + east / (111200 * std::cos(radFromDeg(summit.latDeg))));
      if (!hit) return tl::unexpected(hit.error());
      places.push_back(hit->position);
    }
  }
  const double lowestM = std::ranges::min_element(places, {}, &Geodetic::altM)->altM;
  const double wantedM = (lowestM + summit.altM) / 2;
  return *std::ranges::min_element(places, {}, [&](const Geodetic& g) { return std::abs(g.altM - wantedM); });
}

}  // namespace

Result<std::vector<Summit>> terrainSummits(const DatabaseReader& reader, size_t most) {
  const auto lower = [](const ChunkMeta& a, const ChunkMeta& b) { return a.maxHeightM < b.maxHeightM; };
  std::priority_queue<ChunkMeta, std::vector<ChunkMeta>, decltype(lower)> highest(lower);
  for (int octant = 0; octant < kOctants; ++octant) {
    const Result<ChunkMeta> root = reader.readMeta(TileKey::octantRoot(octant));
    if (!root) return tl::unexpected(root.error());
    highest.push(*root);
  }
  std::vector<Summit> summits;
  while (!highest.empty() && summits.size() < most && highest.top().maxHeightM > 1) {
    const ChunkMeta meta = highest.top();
    highest.pop();
    if (meta.childCount > 0 && meta.key.level() < kSummitLevel) {
      for (const TileKey& key : meta.key.children()) {
        const Result<ChunkMeta> child = reader.readMeta(key);
        if (!child) return tl::unexpected(child.error());
        highest.push(*child);
      }
      continue;
    }
    const Result<StoredChunk> stored = reader.read(meta.key);
    if (!stored) return tl::unexpected(stored.error());
    const Result<ChunkMesh> mesh = decodeMesh(stored->mesh, meta.key);
    if (!mesh) return tl::unexpected(mesh.error());
    const std::vector<Geodetic> vertices = vertexPositions(*mesh, stored->meta);
    const Geodetic top = *std::ranges::max_element(vertices, {}, &Geodetic::altM);
    const bool isNew = std::ranges::none_of(
        summits, [&](const Summit& s) { return apartM(s.latDeg, s.lonDeg, top.latDeg, top.lonDeg) < kSummitsApartM; });
    if (isNew) summits.push_back({fmt::format("{:.0f} m", top.altM), top.latDeg, top.lonDeg, top.altM});
  }
  return summits;
}

Result<std::vector<Viewpoint>> summitViewpoints(std::vector<Summit> summits, size_t pairs, GroundQuery& ground) {
  std::ranges::stable_sort(summits, std::greater<>(), [](const Summit& s) { return s.heightM.value_or(0); });
  std::vector<Viewpoint> viewpoints;
  for (const Summit& summit : summits) {
    if (viewpoints.size() == 2 * pairs) break;
    const bool isNear = std::ranges::any_of(viewpoints, [&](const Viewpoint& v) {
      return apartM(v.eye.latDeg, v.eye.lonDeg, summit.latDeg, summit.lonDeg) < kViewpointsApartM;
    });
    if (isNear || !summit.heightM) continue;
    const Result<Geodetic> top = climb(ground, {summit.latDeg, summit.lonDeg, 0}, kSummitReachM);
    if (!top) return tl::unexpected(top.error());
    if (std::abs(top->altM - *summit.heightM) > kSameSummitM) continue;
    const Result<Geodetic> half = halfWayUp(ground, *top);
    if (!half) return tl::unexpected(half.error());
    viewpoints.push_back({summit.name, {top->latDeg, top->lonDeg, top->altM + kEyeM}});
    viewpoints.push_back({"half way up to " + summit.name, {half->latDeg, half->lonDeg, half->altM + kEyeM}});
  }
  return viewpoints;
}

Result<bool> isInSight(GroundQuery& ground, const Geodetic& eye, const Geodetic& top, double refraction) {
  constexpr double kStepM = 5000, kOwnSlopeM = 300, kOverTopM = 3;
  const Vec3d end = offsetEnu(eye, {top.latDeg, top.lonDeg, top.altM + kOverTopM}, EarthShape::ellipsoid);
  const Vec3d eyeEcefM = ecefFromGeodetic(eye), topEcefM = ecefFromGeodetic(top);
  const Mat3d axes = ecefFromEnu(eye.latDeg, eye.lonDeg);
  const double levelSquared = end.x * end.x + end.y * end.y, bendPerM = refraction / (2 * kMeanEarthRadiusM);
  const int steps = 1 + static_cast<int>(glm::length(end) / kStepM);
  // The ray's height over the chord: it starts higher and comes down onto the end.
  const auto at = [&](int i) {
    const double t = static_cast<double>(i) / steps;
    return eyeEcefM + axes * Vec3d(t * end.x, t * end.y, t * end.z + bendPerM * levelSquared * t * (1 - t));
  };
  for (int i = 0; i < steps; ++i) {
    const auto hit = ground.between(at(i), at(i + 1));
    if (!hit) return tl::unexpected(hit.error());
    if (*hit) return glm::distance(ecefFromGeodetic((*hit)->position), topEcefM) < kOwnSlopeM;
  }
  return true;
}

}  // namespace eye
