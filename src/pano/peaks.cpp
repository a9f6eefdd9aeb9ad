#include "pano/peaks.h"

#include <algorithm>
#include <array>
#include <future>
#include <thread>

#include <fmt/format.h>

#include "paging/region.h"
#include "pano/line_of_sight.h"
#include "raster/gdal.h"

namespace eye {
namespace {

constexpr double kMetresPerDeg = 111200;
// Where ground and gazetteer differ by more, the terrain does not have this summit: outside of its data, say.
// Of a low hill less: it is not the plain beyond the data.
constexpr double kSameSummitM = 300, kSameSummitShare = 0.25, kSameHillM = 50;
// A summit that shows by less than this is lost between two pixels of the map.
constexpr double kLeastShownPx = 0.5;
constexpr double kHighestM = 8850;
constexpr double kReachMargin = 1.1;  // refraction along the way to the horizon is not the same everywhere

// What all summits are looked for in. Read by several threads.
struct Scene {
  const Panorama& panorama;
  const PanoramaOptions& options;
  SceneBend bend;
  std::vector<float> farthestM;  // ground, by column; 0: none
};

std::vector<float> farthestByColumn(const Panorama& panorama) {
  const PanoramaFrame& frame = panorama.frame;
  std::vector<float> farthestM(static_cast<size_t>(frame.widthPx), 0);
  for (int row = 0; row < frame.heightPx; ++row) {
    const float* const distanceM = &panorama.distanceM[frame.at(0, row)];
    // NaN is not greater than anything.
    for (size_t column = 0; column < farthestM.size(); ++column)
      if (distanceM[column] > farthestM[column]) farthestM[column] = distanceM[column];
  }
  return farthestM;
}

// How far a summit can be at most: farthestGroundM is for the usual refraction, and goes with the root of the radius
// that the Earth seems to have.
double farthestSummitM(const PanoramaOptions& options, double summitM) {
  constexpr double kUsualRefraction = 0.13;
  const double flatter = std::sqrt((1 - kUsualRefraction) / (1 - options.refraction));
  return kReachMargin * flatter * farthestGroundM(options.eye.altM, summitM);
}

// Whether some pixel around the gazetteer's place is as far as a summit there would be: else it needs no closer look.
bool mayBeSeen(const Scene& scene, const Sighting& seen) {
  const PanoramaFrame& frame = scene.panorama.frame;
  const double aroundM = kSummitReachM + kSameSummitM;
  const double reachPx =
      std::min(degFromRad(aroundM / std::max(seen.distanceM, 1.0)) / frame.degPerPx() + 3, frame.widthPx / 4.0);
  const double slackM = aroundM + ownSlopeM(seen.distanceM);
  const double x = frame.xOf(seen.azimuthDeg), y = frame.yOf(seen.elevationDeg);
  const int highest = static_cast<int>(std::clamp(y - reachPx, 0.0, frame.heightPx - 1.0));
  const int lowest = static_cast<int>(std::clamp(y + reachPx, 0.0, frame.heightPx - 1.0));
  for (int across = -static_cast<int>(reachPx); across <= reachPx; ++across) {
    const int column = (static_cast<int>(x) + across + frame.widthPx) % frame.widthPx;
    if (scene.farthestM[static_cast<size_t>(column)] < seen.distanceM - slackM) continue;
    for (int row = highest; row <= lowest; ++row)
      if (std::abs(scene.panorama.distanceM[frame.at(column, row)] - seen.distanceM) <= slackM) return true;
  }
  return false;
}

// Nothing where the summit is out of reach; its height the terrain's where the gazetteer has none.
Result<std::optional<PanoramaPeak>> withinReach(const Scene& scene, const Summit& summit, GroundQuery& ground) {
  PanoramaPeak peak{.name = summit.name, .summit = {summit.latDeg, summit.lonDeg, summit.heightM.value_or(0)}};
  const PanoramaOptions& options = scene.options;
  Sighting seen = sightingOf(options.eye, peak.summit, scene.bend, options.earth);
  const double mostM = farthestSummitM(options, summit.heightM.value_or(kHighestM));
  if (seen.distanceM > mostM || seen.distanceM < 1) return std::optional<PanoramaPeak>{};
  if (!summit.heightM) {
    const Result<GroundHit> under = ground.under(summit.latDeg, summit.lonDeg);
    if (!under) return tl::unexpected(under.error());
    peak.summit.altM = under->position.altM;
    seen = sightingOf(options.eye, peak.summit, scene.bend, options.earth);
  }
  peak.azimuthDeg = seen.azimuthDeg, peak.elevationDeg = seen.elevationDeg, peak.trueM = seen.distanceM;
  return std::optional(std::move(peak));
}

// The ground's summit, whether it is in sight, and what the map has of it.
Result<void> look(const Scene& scene, GroundQuery& ground, PanoramaPeak& peak) {
  const PanoramaOptions& options = scene.options;
  const PanoramaFrame& frame = scene.panorama.frame;
  if (!mayBeSeen(scene, {peak.azimuthDeg, peak.elevationDeg, peak.trueM})) return {};
  const Result<Geodetic> top = climb(ground, peak.summit, kSummitReachM);
  if (!top) return tl::unexpected(top.error());
  peak.ground = *top;
  const double sameM = std::min(kSameSummitM, kSameHillM + kSameSummitShare * std::abs(peak.summit.altM));
  if (std::abs(peak.ground.altM - peak.summit.altM) >= sameM) return {};
  const Sighting drawn = sightingOf(options.eye, peak.ground, scene.bend, options.earth);
  peak.x = frame.xOf(drawn.azimuthDeg), peak.y = frame.yOf(drawn.elevationDeg), peak.groundM = drawn.distanceM;
  const std::optional<size_t> pixel = summitPixel(scene.panorama, peak.x, peak.y, peak.groundM);
  if (!pixel) return {};
  const Result<bool> inSight =
      isInSight(ground, options.eye, peak.ground, scene.bend, kLeastShownPx * radFromDeg(frame.degPerPx()));
  if (!inSight) return tl::unexpected(inSight.error());
  peak.visible = *inSight;
  peak.measuredM = static_cast<double>(scene.panorama.told()[*pixel]);
  return {};
}

// Of a summit about the eye, radians; good enough to put summits in order.
double roughAzimuth(const Geodetic& eye, const Summit& summit) {
  const double east = std::remainder(summit.lonDeg - eye.lonDeg, 360.0) * std::cos(radFromDeg(eye.latDeg));
  return std::atan2(east, summit.latDeg - eye.latDeg);
}

std::string quoted(const std::string& name) {
  std::string text = "\"";
  for (const char c : name) text += c == '"' ? "\"\"" : std::string(1, c);
  return text + "\"";
}

}  // namespace

std::optional<size_t> summitPixel(const Panorama& panorama, double x, double y, double summitM) {
  constexpr int kRowsUnder = 2;
  const PanoramaFrame& frame = panorama.frame;
  const int column = std::clamp(static_cast<int>(x), 0, frame.widthPx - 1), first = static_cast<int>(std::floor(y));
  for (int row = std::max(first, 0); row <= std::min(first + kRowsUnder, frame.heightPx - 1); ++row)
    if (std::abs(panorama.distanceM[frame.at(column, row)] - summitM) <= ownSlopeM(summitM))
      return frame.at(column, row);
  return std::nullopt;
}

Sighting sightingOf(const Geodetic& eye, const Geodetic& point, const SceneBend& bend, EarthShape earth) {
  const Vec3d straight = offsetEnu(eye, point, earth);
  const Vec3d drawn = bentEnu(bend, offsetEnu(eye, point, EarthShape::ellipsoid));
  const double azimuthDeg = degFromRad(std::atan2(drawn.x, drawn.y));
  return {azimuthDeg < 0 ? azimuthDeg + 360 : azimuthDeg, degFromRad(std::atan2(drawn.z, std::hypot(drawn.x, drawn.y))),
          glm::length(straight)};
}

Result<Geodetic> climb(GroundQuery& ground, const Geodetic& from, double reachM) {
  const double lonM = kMetresPerDeg * std::max(0.01, std::cos(radFromDeg(from.latDeg)));
  const auto under = [&](double eastM, double northM) {
    return ground.under(std::clamp(from.latDeg + northM / kMetresPerDeg, -90.0, 90.0), from.lonDeg + eastM / lonM);
  };
  Result<GroundHit> best = under(0, 0);
  double eastM = 0, northM = 0;
  for (double stepM = 60; stepM >= 4 && best;) {
    bool climbed = false;
    for (const auto& [east, north] : {std::array{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}) {
      const double e = eastM + east * stepM, n = northM + north * stepM;
      if (std::hypot(e, n) > reachM) continue;
      const Result<GroundHit> hit = under(e, n);
      if (!hit) return tl::unexpected(hit.error());
      if (hit->position.altM <= best->position.altM) continue;
      best = hit, eastM = e, northM = n, climbed = true;
    }
    if (!climbed) stepM /= 2;
  }
  if (!best) return tl::unexpected(best.error());
  return best->position;
}

Result<std::vector<PanoramaPeak>> findPeaks(const Panorama& panorama, const PanoramaOptions& options,
                                            std::span<const Summit> summits) {
  const Scene scene{panorama, options, sceneBend(options.eye.latDeg, options.refraction, options.earth),
                    farthestByColumn(panorama)};
  // Each worker has a stretch of the horizon: what it looks at lies in a few chunks, which it keeps decoded.
  std::vector<const Summit*> round;
  for (const Summit& summit : summits) round.push_back(&summit);
  std::ranges::stable_sort(round, {}, [&](const Summit* s) { return roughAzimuth(options.eye, *s); });

  using Found = Result<std::vector<PanoramaPeak>>;
  const auto findIn = [&](std::span<const Summit* const> part) -> Found {
    Result<GroundQuery> ground = GroundQuery::open(options.terrain);
    if (!ground) return tl::unexpected(ground.error());
    std::vector<PanoramaPeak> peaks;
    for (const Summit* summit : part) {
      auto peak = withinReach(scene, *summit, *ground);
      if (!peak) return tl::unexpected(peak.error());
      if (!*peak) continue;
      if (const auto looked = look(scene, *ground, **peak); !looked) return tl::unexpected(looked.error());
      peaks.push_back(std::move(**peak));
    }
    return peaks;
  };
  const size_t workers = std::max(1u, std::thread::hardware_concurrency());
  const auto bound = [&](size_t worker) { return round.size() * worker / workers; };
  std::vector<std::future<Found>> parts;
  for (size_t i = 1; i < workers; ++i)
    parts.push_back(
        std::async(std::launch::async, findIn, std::span(round).subspan(bound(i), bound(i + 1) - bound(i))));
  Found peaks = findIn(std::span(round).first(bound(1)));
  for (std::future<Found>& part : parts) {
    Found more = part.get();
    if (!more) peaks = std::move(more);
    if (peaks && more) std::ranges::move(*more, std::back_inserter(*peaks));
  }
  if (peaks) std::ranges::stable_sort(*peaks, {}, &PanoramaPeak::trueM);
  return peaks;
}

Result<void> writePeaks(const std::string& path, std::span<const PanoramaPeak> peaks) {
  std::string text =
      "name,lat,lon,height_m,azimuth_deg,elevation_deg,visible,distance_m,true_distance_m,error_m,x_px,y_px\n";
  for (const PanoramaPeak& peak : peaks) {
    const Geodetic& s = peak.summit;
    text += fmt::format("{},{:.6f},{:.6f},{:.1f},{:.4f},{:.4f},{},", quoted(peak.name), s.latDeg, s.lonDeg, s.altM,
                        peak.azimuthDeg, peak.elevationDeg, peak.visible ? 1 : 0);
    text += peak.visible ? fmt::format("{:.1f},{:.1f},{:.1f},{:.1f},{:.1f}\n", peak.measuredM, peak.trueM,
                                       peak.measuredM - peak.trueM, peak.x, peak.y)
                         : fmt::format(",{:.1f},,,\n", peak.trueM);
  }
  return writeFileWhole(path, std::as_bytes(std::span(text)));
}

}  // namespace eye
