#include "render/star_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

namespace eye {
namespace {

struct NamedStar {
  double rightAscensionH, declinationDeg, magnitude;
};

// The stars that navigators and constellations go by: right ascension and declination of 2000 to a minute of arc or so,
// visual magnitude. From common tables; by constellation or neighbourhood.
constexpr std::array kNamedStars{
    NamedStar{6.752, -16.72, -1.46}, NamedStar{6.400, -52.70, -0.74}, NamedStar{14.660, -60.83, -0.27},
    NamedStar{14.261, 19.18, -0.05}, NamedStar{18.616, 38.78, 0.03},  NamedStar{5.278, 46.00, 0.08},
    NamedStar{5.242, -8.20, 0.13},   NamedStar{7.655, 5.22, 0.34},    NamedStar{1.629, -57.24, 0.46},
    NamedStar{5.919, 7.41, 0.50},    NamedStar{14.064, -60.37, 0.61}, NamedStar{19.846, 8.87, 0.76},
    NamedStar{12.443, -63.10, 0.76}, NamedStar{4.599, 16.51, 0.86},   NamedStar{16.490, -26.43, 0.96},
    NamedStar{13.420, -11.16, 0.97}, NamedStar{7.755, 28.03, 1.14},   NamedStar{22.961, -29.62, 1.16},
    NamedStar{20.690, 45.28, 1.25},  NamedStar{12.795, -59.69, 1.25}, NamedStar{10.139, 11.97, 1.39},
    NamedStar{6.977, -28.97, 1.50},  NamedStar{7.577, 31.89, 1.58},   NamedStar{17.560, -37.10, 1.62},
    NamedStar{12.519, -57.11, 1.64}, NamedStar{5.419, 6.35, 1.64},    NamedStar{5.438, 28.61, 1.65},
    NamedStar{9.220, -69.72, 1.67},  NamedStar{5.604, -1.20, 1.69},   NamedStar{22.137, -46.96, 1.74},
    NamedStar{5.679, -1.94, 1.77},   NamedStar{12.900, 55.96, 1.77},  NamedStar{8.159, -47.34, 1.78},
    NamedStar{11.062, 61.75, 1.79},  NamedStar{3.405, 49.86, 1.79},   NamedStar{7.140, -26.39, 1.83},
    NamedStar{18.403, -34.38, 1.85}, NamedStar{8.375, -59.51, 1.86},  NamedStar{13.792, 49.31, 1.86},
    NamedStar{17.622, -43.00, 1.87}, NamedStar{5.992, 44.95, 1.90},   NamedStar{16.811, -69.03, 1.92},
    NamedStar{6.629, 16.40, 1.93},   NamedStar{20.427, -56.74, 1.94}, NamedStar{6.378, -17.96, 1.98},
    NamedStar{2.530, 89.26, 1.98},   NamedStar{9.460, -8.66, 1.98},   NamedStar{2.120, 23.46, 2.00},
    NamedStar{18.921, -26.30, 2.02}, NamedStar{0.726, -17.99, 2.04},  NamedStar{1.162, 35.62, 2.05},
    NamedStar{0.140, 29.09, 2.06},   NamedStar{5.796, -9.67, 2.06},   NamedStar{14.111, -36.37, 2.06},
    NamedStar{17.582, 12.56, 2.07},  NamedStar{14.845, 74.16, 2.08},  NamedStar{10.333, 19.84, 2.08},
    NamedStar{3.136, 40.96, 2.12},   NamedStar{11.818, 14.57, 2.13},  NamedStar{20.370, 40.26, 2.20},
    NamedStar{9.133, -43.43, 2.21},  NamedStar{5.533, -0.30, 2.23},   NamedStar{0.675, 56.54, 2.23},
    NamedStar{15.578, 26.71, 2.23},  NamedStar{17.943, 51.49, 2.23},  NamedStar{8.060, -40.00, 2.25},
    NamedStar{13.399, 54.93, 2.27},  NamedStar{0.153, 59.15, 2.27},   NamedStar{11.031, 56.38, 2.37},
    NamedStar{23.063, 28.08, 2.42},  NamedStar{11.897, 53.69, 2.44},  NamedStar{20.770, 33.97, 2.46},
    NamedStar{0.945, 60.72, 2.47},   NamedStar{23.079, 15.21, 2.49},  NamedStar{1.430, 60.24, 2.68},
    NamedStar{12.252, -58.75, 2.80}, NamedStar{0.221, 15.18, 2.83},   NamedStar{19.750, 45.13, 2.87},
    NamedStar{19.512, 27.96, 3.08},  NamedStar{12.257, 57.03, 3.31},  NamedStar{1.907, 63.67, 3.38},
};

// To magnitude 5.5, as many as there are: each magnitude has three times the stars of the one before.
constexpr size_t kMadeUpStars = 2800;
constexpr double kBrightestMadeUp = 2.9, kFaintest = 5.5, kStarsPerMagnitude = 3.1;
constexpr uint32_t kSeed = 4;

// A spot of soft light; smaller ones would flicker when the view turns.
constexpr double kSpotPx = 3;
// The sine of the sun's height below which the first stars come out, and the height of the eye from which they show by
// day.
constexpr double kDuskSine = -0.07, kDarkSkyM = 15'000;

// Displayed brightness is about the square root of light: 2.512^(-m / 2.2).
float displayed(double magnitude) {
  return static_cast<float>(std::min(1.0, std::pow(10.0, -0.4 * magnitude / 2.2)));
}

Vec3d directionOf(double rightAscensionRad, double sinDeclination) {
  const double cosDeclination = std::sqrt(1 - sinDeclination * sinDeclination);
  return {cosDeclination * std::cos(rightAscensionRad), cosDeclination * std::sin(rightAscensionRad), sinDeclination};
}

std::vector<Star> makeStars() {
  std::vector<Star> made;
  for (const NamedStar& star : kNamedStars) {
    made.push_back(
        {directionOf(star.rightAscensionH * std::numbers::pi / 12, std::sin(radFromDeg(star.declinationDeg))),
         displayed(star.magnitude)});
  }
  std::mt19937 random(kSeed);
  const auto unit = [&] { return (static_cast<double>(random()) + 0.5) / 4294967296.0; };
  for (size_t i = 0; i < kMadeUpStars; ++i) {
    const double rightAscensionRad = 2 * std::numbers::pi * unit(), sinDeclination = 2 * unit() - 1;
    // The count up to a magnitude grows by kStarsPerMagnitude each: the inverse of that distribution.
    const double span = std::pow(kStarsPerMagnitude, kFaintest - kBrightestMadeUp);
    const double magnitude = kBrightestMadeUp + std::log(1 + unit() * (span - 1)) / std::log(kStarsPerMagnitude);
    made.push_back({directionOf(rightAscensionRad, sinDeclination), displayed(magnitude)});
  }
  std::sort(made.begin(), made.end(), [](const Star& a, const Star& b) { return a.brightness > b.brightness; });
  return made;
}

}  // namespace

std::span<const Star> stars() {
  static const std::vector<Star> all = makeStars();
  return all;
}

bool starsShow(const FrameInput& input) {
  if (input.background) return false;
  const Geodetic eye = geodeticFromEcef(input.view.eyeEcefM);
  return eye.altM > kDarkSkyM || glm::dot(upAt(eye.latDeg, eye.lonDeg), input.lighting.sunDirectionEcef) < kDuskSine;
}

void placeStars(const FrameInput& input, std::vector<StarInstance>& placed) {
  placed.clear();
  if (!starsShow(input)) return;
  const View& view = input.view;
  const Frustum& f = view.frustum;
  const double width = f.tanRight - f.tanLeft, height = f.tanTop - f.tanBottom;
  const double turn = input.lighting.siderealRad, cosTurn = std::cos(turn), sinTurn = std::sin(turn);
  const glm::vec2 half(kSpotPx / view.widthPx, kSpotPx / view.heightPx);
  for (const Star& star : stars()) {
    const Vec3d& d = star.direction;
    const Vec3d ecef(cosTurn * d.x + sinTurn * d.y, cosTurn * d.y - sinTurn * d.x, d.z);
    const Vec3d eye = view.eyeFromEcef * ecef;
    if (eye.z <= 0) continue;
    // As clipFromEcef projects: x right, y down.
    const double x = (2 * eye.x / eye.z - (f.tanRight + f.tanLeft)) / width;
    const double y = (2 * eye.y / eye.z + (f.tanTop + f.tanBottom)) / height;
    if (std::abs(x) > 1 || std::abs(y) > 1) continue;
    placed.push_back({glm::vec2(x, y), half, glm::vec3(eye), star.brightness});
  }
}

}  // namespace eye
