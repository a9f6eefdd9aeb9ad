#include "bench/summit_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
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

// Best first: a chunk by the height that nothing in it exceeds, its highest vertex once that is known.
Result<std::vector<Summit>> terrainSummits(const DatabaseReader& reader, size_t most) {
  struct Waiting {
    double heightM = 0;
    TileKey key;
    std::optional<Geodetic> top;
    bool operator<(const Waiting& other) const { return heightM < other.heightM; }
  };
  std::priority_queue<Waiting> highest;
  const auto push = [&](const TileKey& key) -> Result<void> {
    const Result<ChunkMeta> meta = reader.readMeta(key);
    if (!meta) return tl::unexpected(meta.error());
    highest.push({meta->maxHeightM, key, {}});
    return {};
  };
  for (int octant = 0; octant < kOctants; ++octant)
    if (const auto pushed = push(TileKey::octantRoot(octant)); !pushed) return tl::unexpected(pushed.error());
  std::vector<Summit> summits;
  while (!highest.empty() && summits.size() < most && highest.top().heightM > 1) {
    const Waiting next = highest.top();
    highest.pop();
    if (next.top) {
      const Geodetic& top = *next.top;
      const bool isNew = std::ranges::none_of(summits, [&](const Summit& s) {
        return apartM(s.latDeg, s.lonDeg, top.latDeg, top.lonDeg) < kSummitsApartM;
      });
      if (isNew) summits.push_back({fmt::format("{:.0f} m", top.altM), top.latDeg, top.lonDeg, top.altM});
      continue;
    }
    const Result<StoredChunk> stored = reader.read(next.key);
    if (!stored) return tl::unexpected(stored.error());
    if (stored->meta.childCount > 0 && next.key.level() < kSummitLevel) {
      for (const TileKey& key : next.key.children())
        if (const auto pushed = push(key); !pushed) return tl::unexpected(pushed.error());
      continue;
    }
    const Result<ChunkMesh> mesh = decodeMesh(stored->mesh, next.key);
    if (!mesh) return tl::unexpected(mesh.error());
    const std::vector<Geodetic> vertices = vertexPositions(*mesh, stored->meta);
    const Geodetic top = *std::ranges::max_element(vertices, {}, &Geodetic::altM);
    highest.push({top.altM, next.key, top});
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

Result<bool> isInSight(GroundQuery& ground, const Geodetic& eye, const Geodetic& top, double refraction,
                       double underRad) {
  constexpr double kStepM = 5000, kOwnSlopeM = 1000;
  Vec3d end = offsetEnu(eye, top, EarthShape::ellipsoid);
  end.z -= underRad * glm::length(end);
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
  return false;  // past the top
}

}  // namespace eye
