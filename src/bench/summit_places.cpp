#include "bench/summit_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <queue>

#include <fmt/format.h>

#include "bench/ground_heights.h"
#include "geo/scene_bend.h"
#include "pano/line_of_sight.h"
#include "pano/peaks.h"

namespace eye {
namespace {

constexpr int kSummitLevel = 13;  // cells of 1.2 km
constexpr double kSummitsApartM = 2000, kViewpointsApartM = 40000, kValleysApartM = 5000;
constexpr double kEyeM = 2;
constexpr double kSameSummitM = 300;  // between gazetteer and terrain; else the terrain does not have it

double apartM(double latA, double lonA, double latB, double lonB) {
  return glm::distance(ecefFromGeodetic({latA, lonA, 0}), ecefFromGeodetic({latB, lonB, 0}));
}

Geodetic placeAround(const Geodetic& centre, double awayM, double turnDeg) {
  const double north = awayM * std::cos(radFromDeg(turnDeg)), east = awayM * std::sin(radFromDeg(turnDeg));
  return {centre.latDeg + north / 111200, centre.lonDeg + east / (111200 * std::cos(radFromDeg(centre.latDeg))), 0};
}

// Ground in sixteen directions at some distances; nothing on the sea that lies outside of the data or within 2 km of
// it.
Result<std::vector<Geodetic>> groundAround(GroundQuery& ground, const Geodetic& summit,
                                           std::initializer_list<double> distancesM) {
  constexpr double kDryM = 1, kOffTheShoreM = 2000;
  std::vector<Geodetic> places;
  for (const double awayM : distancesM) {
    for (int i = 0; i < 16; ++i) {
      const Geodetic place = placeAround(summit, awayM, 22.5 * i);
      bool isDry = true;
      double altM = 0;
      for (int side = -1; side < 4 && isDry; ++side) {
        const Geodetic at = side < 0 ? place : placeAround(place, kOffTheShoreM, 90.0 * side);
        const auto hit = ground.under(at.latDeg, at.lonDeg);
        if (!hit) return tl::unexpected(hit.error());
        if (side < 0) altM = hit->position.altM;
        isDry = hit->position.altM > kDryM;
      }
      if (isDry) places.push_back({place.latDeg, place.lonDeg, altM});
    }
  }
  return places;
}

// The ground that is nearest to half the height between the lowest around and the summit.
Geodetic halfWayUp(const Geodetic& summit, const std::vector<Geodetic>& around) {
  const double lowestM = std::ranges::min_element(around, {}, &Geodetic::altM)->altM;
  const double wantedM = (lowestM + summit.altM) / 2;
  return *std::ranges::min_element(around, {}, [&](const Geodetic& g) { return std::abs(g.altM - wantedM); });
}

// Summits higher than an eye that it sees, of the nearest few beyond 3 km.
Result<size_t> summitsOver(GroundQuery& ground, const Geodetic& eye, const std::vector<Summit>& summits) {
  constexpr double kNearestM = 3000, kShownRad = 0.001;
  constexpr size_t kMostTried = 120;
  std::vector<std::pair<double, Geodetic>> higher;
  for (const Summit& s : summits) {
    const double awayM = apartM(eye.latDeg, eye.lonDeg, s.latDeg, s.lonDeg);
    if (s.heightM.value_or(0) > eye.altM && awayM > kNearestM) higher.push_back({awayM, {s.latDeg, s.lonDeg, 0}});
  }
  const size_t tried = std::min(kMostTried, higher.size());
  std::ranges::partial_sort(higher, higher.begin() + static_cast<std::ptrdiff_t>(tried), {},
                            &std::pair<double, Geodetic>::first);
  const SceneBend bend = sceneBend(eye.latDeg, 0.13, EarthShape::ellipsoid);
  size_t seen = 0;
  for (size_t i = 0; i < tried; ++i) {
    const Result<Geodetic> top = climb(ground, higher[i].second, kSummitReachM);
    if (!top) return tl::unexpected(top.error());
    const Result<bool> inSight = isInSight(ground, eye, *top, bend, kShownRad);
    if (!inSight) return tl::unexpected(inSight.error());
    seen += *inSight ? size_t{1} : size_t{0};
  }
  return seen;
}

// Of the lowest places around, those that see the most of the mountains over them; some kilometres apart.
Result<std::vector<Geodetic>> valleys(GroundQuery& ground, std::vector<Geodetic> around,
                                      const std::vector<Summit>& summits, size_t most) {
  constexpr size_t kLowest = 24;
  std::ranges::sort(around, {}, &Geodetic::altM);
  around.resize(std::min(kLowest, around.size()));
  std::vector<std::pair<size_t, Geodetic>> best;
  for (const Geodetic& place : around) {
    const Result<size_t> seen = summitsOver(ground, {place.latDeg, place.lonDeg, place.altM + kEyeM}, summits);
    if (!seen) return tl::unexpected(seen.error());
    best.push_back({*seen, place});
  }
  std::ranges::stable_sort(best, std::greater<>(), &std::pair<size_t, Geodetic>::first);
  std::vector<Geodetic> chosen;
  for (const auto& [seen, place] : best) {
    const bool isNear = std::ranges::any_of(chosen, [&](const Geodetic& other) {
      return apartM(other.latDeg, other.lonDeg, place.latDeg, place.lonDeg) < kValleysApartM;
    });
    if (!isNear && chosen.size() < most) chosen.push_back(place);
  }
  return chosen;
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

Result<std::vector<Viewpoint>> summitViewpoints(std::vector<Summit> summits, const ViewpointWish& wish,
                                                GroundQuery& ground) {
  std::ranges::stable_sort(summits, std::greater<>(), [](const Summit& s) { return s.heightM.value_or(0); });
  std::vector<Viewpoint> viewpoints;
  std::vector<Geodetic> tops;
  const auto stand = [&](const std::string& name, const Geodetic& place) {
    viewpoints.push_back({name, {place.latDeg, place.lonDeg, place.altM + kEyeM}});
  };
  for (const Summit& summit : summits) {
    if (tops.size() == wish.mountains) break;
    const bool isNear = std::ranges::any_of(tops, [&](const Geodetic& top) {
      return apartM(top.latDeg, top.lonDeg, summit.latDeg, summit.lonDeg) < kViewpointsApartM;
    });
    if (isNear || !summit.heightM) continue;
    const Result<Geodetic> top = climb(ground, {summit.latDeg, summit.lonDeg, 0}, kSummitReachM);
    if (!top) return tl::unexpected(top.error());
    if (std::abs(top->altM - *summit.heightM) > kSameSummitM) continue;
    const auto flanks = groundAround(ground, *top, {3000, 6000, 9000, 12000});
    if (!flanks) return tl::unexpected(flanks.error());
    const auto foreland = groundAround(ground, *top, {6000, 9000, 12000, 16000, 20000, 25000});
    if (!foreland) return tl::unexpected(foreland.error());
    if (flanks->empty() || foreland->empty()) continue;
    const auto below = valleys(ground, *foreland, summits, wish.valleys);
    if (!below) return tl::unexpected(below.error());
    tops.push_back(*top);
    stand(summit.name, *top);
    stand("half way up to " + summit.name, halfWayUp(*top, *flanks));
    for (const Geodetic& valley : *below) stand("valley below " + summit.name, valley);
  }
  return viewpoints;
}

}  // namespace eye
