// Which summits are visible and how far they are said to be, where both are known: a ridge that hides one summit close
// behind it and not the other.
#include <cmath>
#include <map>

#include <GeographicLib/Geocentric.hpp>
#include <catch2/catch.hpp>

#include "bake/baked_ground.h"
#include "pano/line_of_sight.h"
#include "pano/peaks.h"
#include "pano/run.h"
#include "render/renderer.h"

namespace eye {
namespace {

const Geodetic kEye{46, 8, 502};
constexpr double kPlainM = 500;
// Everything stands on posts, so that none of its height falls between two.
constexpr double kPostDeg = 1.0 / 1200, kNorthPostM = 111200 * kPostDeg, kEastPostM = kNorthPostM * 0.69466;

double eastM(double lonDeg) {
  return (lonDeg - kEye.lonDeg) / kPostDeg * kEastPostM;
}
double northM(double latDeg) {
  return (latDeg - kEye.latDeg) / kPostDeg * kNorthPostM;
}
Summit listed(const char* name, double eastPosts, double northPosts, double heightM) {
  return {name, kEye.latDeg + northPosts * kPostDeg, kEye.lonDeg + eastPosts * kPostDeg, heightM};
}

// A straight ridge 10 km to the east, with summits 190 and 390 m behind it and gaps between.
const std::vector<Summit> kSummits{listed("Hidden", 162, -27, 1520), listed("Over", 162, 27, 1640),
                                   listed("Close", 159, 0, 1510),    listed("North", 0, 100, 2000),
                                   listed("Low", -140, 0, 900),      listed("Nowhere", -90, -60, 2500)};

double heightM(double latDeg, double lonDeg) {
  const double e = eastM(lonDeg), n = northM(latDeg);
  const double ridge = std::abs(n) < 6000 ? 1500 - 1.5 * std::abs(e - 156 * kEastPostM) : 0;
  double highest = std::max(kPlainM, ridge);
  for (const Summit& s : kSummits) {
    const double slope = s.name == "North" || s.name == "Low" ? 0.5 : 1.5;
    if (s.name != "Nowhere")
      highest = std::max(highest, *s.heightM - slope * std::hypot(e - eastM(s.lonDeg), n - northM(s.latDeg)));
  }
  return highest;
}

const std::string& database() {
  static const BakedGround ground(postGrid(45.9, 7.85, 1.0 / 1200, 301, 361), heightM, 1);
  return ground.database;
}

PanoramaOptions optionsFor(DepthKind depth) {
  PanoramaOptions options;
  options.terrain = database();
  options.eye = kEye;
  options.frame = panoramaFrame(8192, 20);
  options.depth = depth;
  options.cacheGpuMiB = 128;
  return options;
}

std::map<std::string, PanoramaPeak> peaksBy(const PanoramaOptions& options, const Panorama& panorama) {
  const auto found = findPeaks(panorama, options, kSummits);
  INFO((found ? std::string() : found.error().message));
  REQUIRE(found);
  std::map<std::string, PanoramaPeak> byName;
  for (const PanoramaPeak& peak : *found) byName[peak.name] = peak;
  return byName;
}

double straightM(const Geodetic& a, const Geodetic& b) {
  const auto place = [](const Geodetic& g) {
    Vec3d p;
    GeographicLib::Geocentric::WGS84().Forward(g.latDeg, g.lonDeg, g.altM, p.x, p.y, p.z);
    return p;
  };
  return glm::distance(place(a), place(b));
}

}  // namespace

TEST_CASE("Peaks: one close behind a ridge is not visible, one over it is and has its own distance") {
  const auto devices = Renderer::listDevices();
  if (!devices || devices->empty()) {
    WARN("no Vulkan device: not tested");
    return;
  }
  for (const DepthKind depth : {DepthKind::range, DepthKind::paper}) {
    CAPTURE(depth == DepthKind::paper);
    const PanoramaOptions options = optionsFor(depth);
    const auto rendered = renderPanorama(options);
    REQUIRE(rendered);
    auto peaks = peaksBy(options, rendered->panorama);
    REQUIRE(peaks.size() == kSummits.size());
    for (const auto& [name, isVisible] : {std::pair{"Hidden", false},
                                          {"Over", true},
                                          {"Close", false},
                                          {"North", true},
                                          {"Low", true},
                                          {"Nowhere", false}}) {
      INFO(name);
      const PanoramaPeak& peak = peaks[name];
      CHECK(peak.visible == isVisible);
      CHECK(peak.trueM == Approx(straightM(kEye, peak.summit)).epsilon(1e-9));
      if (!isVisible) continue;
      const double turnRad = radFromDeg(std::fmod(peak.azimuthDeg, 45.0) - 22.5);
      // The paper's depth is along the view's axis, which is level and in the middle of its 45 degrees.
      const double alongAxis = std::cos(turnRad) * std::cos(radFromDeg(peak.elevationDeg));
      const double toldM = depth == DepthKind::range ? peak.trueM : peak.trueM * alongAxis;
      CHECK(peak.measuredM == Approx(toldM).epsilon(0.01));
      CHECK(peak.groundM == Approx(peak.trueM).epsilon(0.01));
    }
  }
}

TEST_CASE("The eye on a summit: off the gazetteer's place, and with its name") {
  auto ground = GroundQuery::open(database());
  REQUIRE(ground);
  // Two posts beside the top of a cone whose sides fall by a half.
  const Summit& north = kSummits[3];
  EyeWish wish{north.latDeg + 2 * kPostDeg, north.lonDeg, {}, {}};
  const auto beside = placeEye(wish, *ground);
  wish.onSummit = true;
  const auto onTop = placeEye(wish, *ground);
  REQUIRE(beside);
  REQUIRE(onTop);
  CHECK(beside->altM == Approx(2000 - 0.5 * 2 * kNorthPostM + 2).margin(2));
  CHECK(onTop->altM == Approx(2000 + 2).margin(3));
  CHECK(onTop->latDeg == Approx(north.latDeg).margin(0.1 * kPostDeg));
  CHECK_THAT(titleOf(*onTop, kSummits), Catch::StartsWith("North ") && Catch::EndsWith(" m"));
  CHECK_THAT(titleOf({45.95, 7.9, 600}, kSummits), Catch::StartsWith("45.9500"));
}

TEST_CASE("Peaks: how far one is looked for grows with refraction") {
  Panorama sky{panoramaFrame(360, 40), {kEye.latDeg, kEye.lonDeg, 2}, {}, {}, {}};
  sky.distanceM.assign(sky.frame.pixels(), std::numeric_limits<float>::quiet_NaN());
  PanoramaOptions options = optionsFor(DepthKind::range);
  options.eye = sky.eye;
  options.frame = sky.frame;
  // Over the sea a summit of 4,000 m shows up to 326 km away with k = 0.5, and to 231 km with none.
  const std::vector<Summit> far{listed("215 km", 0, 215e3 / kNorthPostM, 4000),
                                listed("320 km", 0, 320e3 / kNorthPostM, 4000),
                                listed("500 km", 0, 500e3 / kNorthPostM, 4000)};
  const auto count = [&](double refraction) {
    options.refraction = refraction;
    const auto peaks = findPeaks(sky, options, far);
    REQUIRE(peaks);
    CHECK(std::ranges::none_of(*peaks, &PanoramaPeak::visible));
    return peaks->size();
  };
  CHECK(count(0) == 1);
  CHECK(count(0.5) == 2);
}

TEST_CASE("Line of sight: what hides a summit, and what is its own slope") {
  auto ground = GroundQuery::open(database());
  REQUIRE(ground);
  const SceneBend bend = sceneBend(kEye.latDeg, 0.13, EarthShape::ellipsoid);
  const auto isSeen = [&](size_t i, double underRad) {
    const Summit& s = kSummits[i];
    const auto top = climb(*ground, {s.latDeg, s.lonDeg, 0}, kSummitReachM);
    REQUIRE(top);
    const auto inSight = isInSight(*ground, kEye, *top, bend, underRad);
    REQUIRE(inSight);
    return *inSight;
  };
  CHECK_FALSE(isSeen(0, 0));
  CHECK_FALSE(isSeen(2, 0));  // near enough to be the ridge's own slope, but for the gap
  CHECK(isSeen(3, 0));
  // It shows by 9.4 milliradians: (1640 - 502) / 10724 less (1500 - 502) / 10326.
  CHECK(isSeen(1, 0));
  CHECK(isSeen(1, 0.0085));
  CHECK_FALSE(isSeen(1, 0.0105));
  // A point in the air is past every ground.
  CHECK_FALSE(isInSight(*ground, kEye, {46.1, 8, 5000}, bend, 0).value());
}

}  // namespace eye
