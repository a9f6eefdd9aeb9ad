// Suite `panorama`: paper 002's Tables 1 to 3. Panoramas from summits, from half way up and from valleys, and how far
// the peaks in them are said to be.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <GeographicLib/Geocentric.hpp>

#include "app/options.h"
#include "bench/panorama_report.h"
#include "bench/suites.h"
#include "bench/summit_places.h"
#include "pano/line_of_sight.h"
#include "pano/peaks.h"
#include "pano/planar_depth.h"
#include "pano/views.h"

namespace eye {
namespace {

constexpr ViewpointWish kViewpoints{.mountains = 3, .valleys = 2}, kQuickViewpoints{.mountains = 1, .valleys = 1};
constexpr int kWidthPx = 8192, kQuickWidthPx = 2048;
constexpr double kVerticalFovDeg = 60;
// A summit that shows by less is not in sight: a pixel's centre may lie above it, or the next one's at its foot.
constexpr double kUnderPx = 1.5;
constexpr double kNearestM = 3000, kFarthestM = 150000;
// Of a viewpoint's peaks so many are tried, spread over all distances.
constexpr size_t kMostTried = 500, kQuickTried = 60;
constexpr size_t kTerrainSummits = 600, kQuickTerrainSummits = 60;
constexpr double kSameSummitM = 300;  // between gazetteer and ground; else the terrain does not have it

// By GeographicLib itself, so that the truth is not our own geodesy.
double straightM(const Geodetic& a, const Geodetic& b) {
  const auto place = [](const Geodetic& g) {
    Vec3d p;
    GeographicLib::Geocentric::WGS84().Forward(g.latDeg, g.lonDeg, g.altM, p.x, p.y, p.z);
    return p;
  };
  return glm::distance(place(a), place(b));
}

// The depth along the axis of the view that shows a point, out of a buffer.
double planarDepthM(const Vec3d& offsetEnu) {
  const double azimuthDeg = degFromRad(std::atan2(offsetEnu.x, offsetEnu.y));
  const double turnDeg = std::fmod(azimuthDeg + 360, kViewDeg) - kViewDeg / 2;
  return std::hypot(offsetEnu.x, offsetEnu.y) * std::cos(radFromDeg(turnDeg));
}

double throughBufferM(const PaperBuffer& buffer, double depthM) {
  return paperDepthM(buffer, paperBufferValue(buffer, depthM));
}

struct Target {
  Geodetic listed, top;  // the gazetteer's, and the ground's
  std::string name;
  double trueM = 0, groundM = 0;
};

// Peaks in sight, without a look at any picture.
Result<std::vector<Target>> targetsOf(const Geodetic& eye, const std::vector<Summit>& summits, const SceneBend& bend,
                                      double underRad, size_t most, GroundQuery& ground) {
  std::vector<Target> near;
  for (const Summit& summit : summits) {
    const Geodetic place{summit.latDeg, summit.lonDeg, summit.heightM.value_or(0)};
    const double awayM = straightM(eye, place);
    if (!summit.heightM || awayM < kNearestM || awayM > kFarthestM) continue;
    const Result<GroundHit> under = ground.under(place.latDeg, place.lonDeg);
    if (!under) return tl::unexpected(under.error());
    if (std::abs(under->position.altM - place.altM) < 2 * kSameSummitM) near.push_back({place, {}, summit.name, awayM});
  }
  std::ranges::stable_sort(near, {}, &Target::trueM);
  std::vector<Target> targets;
  for (size_t i = 0; i < std::min(most, near.size()); ++i) {
    Target target = near[i * near.size() / std::min(most, near.size())];
    const Result<Geodetic> top = climb(ground, target.listed, kSummitReachM);
    if (!top) return tl::unexpected(top.error());
    if (std::abs(top->altM - target.listed.altM) > kSameSummitM) continue;
    const Result<bool> inSight = isInSight(ground, eye, *top, bend, underRad);
    if (!inSight) return tl::unexpected(inSight.error());
    if (!*inSight) continue;
    target.top = *top;
    target.groundM = straightM(eye, *top);
    targets.push_back(std::move(target));
  }
  return targets;
}

MeasuredPeak measured(const Target& target, const Viewpoint& viewpoint, const Panorama& panorama,
                      const SceneBend& bend) {
  const Sighting seen = sightingOf(viewpoint.eye, target.top, bend, EarthShape::ellipsoid);
  const PanoramaFrame& frame = panorama.frame;
  const auto pixel = summitPixel(panorama, frame.xOf(seen.azimuthDeg), frame.yOf(seen.elevationDeg), seen.distanceM);
  const Vec3d offset = offsetEnu(viewpoint.eye, target.top, EarthShape::ellipsoid);
  const double perSquare = 1 / std::cos(radFromDeg(viewpoint.eye.latDeg));
  constexpr PaperBuffer kPaper;
  constexpr PaperBuffer kNearPlane{.nearM = 0.1};
  MeasuredPeak peak{.name = target.name,
                    .viewpoint = viewpoint.name,
                    .isAboveEye = target.listed.altM > viewpoint.eye.altM,
                    .trueM = target.trueM,
                    .groundM = target.groundM};
  if (pixel) {
    peak.toldM[methodRange] = panorama.distanceM[*pixel];
    peak.toldM[methodPaper] = panorama.planarM[*pixel];
  }
  peak.toldM[methodPlanar] = planarDepthM(offset);
  peak.toldM[methodNearPlane] = throughBufferM(kNearPlane, planarDepthM(offset));
  peak.toldM[methodSquareDegrees] = throughBufferM(kPaper, planarDepthM({offset.x * perSquare, offset.y, offset.z}));
  return peak;
}

Result<std::vector<Summit>> summitsFor(const SuiteOptions& options, const std::string& terrain) {
  if (options.peaks.empty()) {
    const Result<DatabaseReader> reader = DatabaseReader::open(terrain);
    if (!reader) return tl::unexpected(reader.error());
    return terrainSummits(*reader, options.quick ? kQuickTerrainSummits : kTerrainSummits);
  }
  return loadGazetteers(options.peaks);
}

}  // namespace

Result<SuiteReport> runPanoramaSuite(const SuiteOptions& options) {
  const std::string terrain = options.terrain.empty() ? defaultTerrainPath() : options.terrain;
  Result<GroundQuery> ground = GroundQuery::open(terrain);
  if (!ground) return tl::unexpected(ground.error());
  const Result<std::vector<Summit>> summits = summitsFor(options, terrain);
  if (!summits) return tl::unexpected(summits.error());
  const auto viewpoints = summitViewpoints(*summits, options.quick ? kQuickViewpoints : kViewpoints, *ground);
  if (!viewpoints) return tl::unexpected(viewpoints.error());

  PanoramaOptions pano;
  pano.terrain = terrain;
  pano.device = options.device;
  pano.depth = DepthKind::paper;  // beside the range
  pano.frame = panoramaFrame(options.quick ? kQuickWidthPx : kWidthPx, kVerticalFovDeg);
  std::vector<MeasuredPeak> peaks;
  std::string device, places;
  for (size_t i = 0; i < viewpoints->size(); ++i) {
    const Viewpoint& viewpoint = (*viewpoints)[i];
    const double share = static_cast<double>(i) / static_cast<double>(viewpoints->size());
    if (options.progress) options.progress(viewpoint.name, share);
    pano.eye = viewpoint.eye;
    const SceneBend bend = sceneBend(pano.eye.latDeg, pano.refraction, pano.earth);
    const auto targets = targetsOf(viewpoint.eye, *summits, bend, kUnderPx * radFromDeg(pano.frame.degPerPx()),
                                   options.quick ? kQuickTried : kMostTried, *ground);
    if (!targets) return tl::unexpected(targets.error());
    const Result<RenderedPanorama> rendered = renderPanorama(pano);
    if (!rendered) return tl::unexpected(rendered.error());
    device = rendered->device;
    for (const Target& target : *targets) peaks.push_back(measured(target, viewpoint, rendered->panorama, bend));
    places += fmt::format("{}{} ({:.4f} N {:.4f} E, {:.0f} m, {} peaks)", i == 0 ? "" : ", ", viewpoint.name,
                          viewpoint.eye.latDeg, viewpoint.eye.lonDeg, viewpoint.eye.altM, targets->size());
  }
  SuiteReport report = panoramaReport(peaks, viewpoints->size());
  report.device = device;
  report.notes.push_back(fmt::format("{}: {}. {} x {} pixels, k = {}.", terrain, places, pano.frame.widthPx,
                                     pano.frame.heightPx, pano.refraction));
  return report;
}

}  // namespace eye
