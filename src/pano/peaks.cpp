#include "pano/peaks.h"

#include <algorithm>
#include <array>
#include <limits>

#include <fmt/format.h>

#include "paging/region.h"
#include "raster/gdal.h"

namespace eye {
namespace {

constexpr double kMetresPerDeg = 111200;
// Where ground and gazetteer differ by more, the terrain does not have this summit: outside of its data, say.
// Of a low hill less: it is not the plain beyond the data.
constexpr double kSameSummitM = 300, kSameSummitShare = 0.25, kSameHillM = 50;
// Something nearer by more than this hides a summit: the share covers the hillside under a flat top, the metres an eye
// that stands on the mountain's own shoulder.
constexpr double kHiddenShare = 0.05, kHiddenM = 150;

double distanceAt(const Panorama& panorama, double x, double y) {
  const PanoramaFrame& frame = panorama.frame;
  const int column = std::clamp(static_cast<int>(x), 0, frame.widthPx - 1), row = static_cast<int>(std::floor(y));
  return row < 0 || row >= frame.heightPx ? std::numeric_limits<double>::quiet_NaN()
                                          : panorama.distanceM[frame.at(column, row)];
}

bool isHidden(double measuredM, double trueM) {
  return measuredM < trueM - std::max(kHiddenM, kHiddenShare * trueM);
}

// Whether some pixel around the place has nothing in front of it: else the summit needs no closer look.
bool mayBeSeen(const Panorama& panorama, const Sighting& seen) {
  const PanoramaFrame& frame = panorama.frame;
  const double aroundRad = (kSummitReachM + kSameSummitM) / std::max(seen.distanceM, 1.0);
  const double x = frame.xOf(seen.azimuthDeg), y = frame.yOf(seen.elevationDeg);
  const double reachPx = std::min(degFromRad(aroundRad) / frame.degPerPx() + 2, frame.widthPx / 4.0);
  const int row = static_cast<int>(std::clamp(y + reachPx, 0.0, frame.heightPx - 1.0));
  const int highest = static_cast<int>(std::clamp(y - reachPx, 0.0, frame.heightPx - 1.0));
  for (double across = -reachPx; across <= reachPx; across += 1) {
    const double wrapped = std::fmod(x + across + frame.widthPx, frame.widthPx);
    for (int r = highest; r <= row; ++r) {
      const double d = distanceAt(panorama, wrapped, r);
      if (!std::isnan(d) && !isHidden(d, seen.distanceM - 2 * kSummitReachM)) return true;
    }
  }
  return false;
}

std::string quoted(const std::string& name) {
  std::string text = "\"";
  for (const char c : name) text += c == '"' ? "\"\"" : std::string(1, c);
  return text + "\"";
}

}  // namespace

double measuredM(const Panorama& panorama, double x, double y) {
  const double at = distanceAt(panorama, x, y + 1);
  return std::isnan(at) ? distanceAt(panorama, x, y + 2) : at;
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
                                            std::span<const Summit> summits, GroundQuery& ground) {
  const PanoramaFrame& frame = panorama.frame;
  const SceneBend bend = sceneBend(options.eye.latDeg, options.refraction, options.earth);
  std::vector<PanoramaPeak> peaks;
  for (const Summit& summit : summits) {
    constexpr double kHighestM = 8850;
    PanoramaPeak peak{.name = summit.name, .summit = {summit.latDeg, summit.lonDeg, summit.heightM.value_or(0)}};
    // Twice: what refraction brings up beside the usual.
    const double mostM = 1.2 * farthestGroundM(options.eye.altM, summit.heightM.value_or(kHighestM));
    Sighting seen = sightingOf(options.eye, peak.summit, bend, options.earth);
    if (seen.distanceM > mostM || seen.distanceM < 1) continue;
    if (!summit.heightM) {
      const Result<GroundHit> under = ground.under(summit.latDeg, summit.lonDeg);
      if (!under) return tl::unexpected(under.error());
      peak.summit.altM = under->position.altM;
      seen = sightingOf(options.eye, peak.summit, bend, options.earth);
    }
    peak.azimuthDeg = seen.azimuthDeg, peak.elevationDeg = seen.elevationDeg, peak.trueM = seen.distanceM;
    if (mayBeSeen(panorama, seen)) {
      const Result<Geodetic> top = climb(ground, peak.summit, kSummitReachM);
      if (!top) return tl::unexpected(top.error());
      peak.ground = *top;
      const Sighting drawn = sightingOf(options.eye, peak.ground, bend, options.earth);
      peak.x = frame.xOf(drawn.azimuthDeg), peak.y = frame.yOf(drawn.elevationDeg), peak.groundM = drawn.distanceM;
      peak.measuredM = measuredM(panorama, peak.x, peak.y);
      const double sameM = std::min(kSameSummitM, kSameHillM + kSameSummitShare * std::abs(peak.summit.altM));
      peak.visible = std::abs(peak.ground.altM - peak.summit.altM) < sameM && !std::isnan(peak.measuredM) &&
                     !isHidden(peak.measuredM, peak.groundM);
    }
    peaks.push_back(std::move(peak));
  }
  std::ranges::stable_sort(peaks, {}, &PanoramaPeak::trueM);
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
