#include "bake/palette.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace eye {

namespace {

constexpr glm::vec3 rgb(int r, int g, int b) {
  return glm::vec3(float(r), float(g), float(b)) / 255.0f;
}

// Sampled by eye from summer orthophotos and true-colour satellite pictures.
const glm::vec3 kDeepWater = rgb(12, 32, 62), kShallowWater = rgb(28, 70, 98), kShoreWater = rgb(40, 88, 112);
const glm::vec3 kBeach = rgb(188, 174, 134);
const glm::vec3 kField = rgb(150, 146, 92), kPasture = rgb(108, 126, 68);
const glm::vec3 kForest = rgb(44, 68, 38), kLightForest = rgb(74, 96, 50);
const glm::vec3 kRainForest = rgb(38, 72, 32), kSteppe = rgb(168, 150, 98), kDesert = rgb(198, 168, 122);
const glm::vec3 kTaiga = rgb(54, 68, 46), kTundra = rgb(124, 116, 88);
const glm::vec3 kMeadow = rgb(118, 124, 72), kScree = rgb(138, 128, 114), kRock = rgb(112, 104, 96);
const glm::vec3 kSnow = rgb(240, 243, 248), kIce = rgb(224, 234, 242);

double smoothstep(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

glm::vec3 mix(const glm::vec3& a, const glm::vec3& b, double share) {
  return glm::mix(a, b, static_cast<float>(share));
}

// Height by |latitude|, linear between knots ten degrees apart.
double byLatitude(const std::array<double, 10>& knots, double latDeg) {
  const double at = std::min(std::abs(latDeg), 89.999) / 10;
  const auto i = static_cast<size_t>(at);
  return knots[i] + (knots[i + 1] - knots[i]) * (at - static_cast<double>(i));
}

glm::vec3 waterColour(double depthM) {
  const glm::vec3 shelf = mix(kShoreWater, kShallowWater, smoothstep(0, 25, depthM));
  return mix(shelf, kDeepWater, smoothstep(10, 1500, depthM));
}

// Open country at sea level: rain forest, savanna and desert, fields, steppe, tundra.
glm::vec3 openColour(double latDeg, double noise) {
  const double lat = std::abs(latDeg) + 3 * noise;
  glm::vec3 colour = mix(kRainForest, kSteppe, smoothstep(8, 17, lat));
  colour = mix(colour, kDesert, smoothstep(15, 21, lat) * (1 - smoothstep(27, 33, lat)));
  colour = mix(colour, mix(kPasture, kField, 0.5 + 0.5 * noise), smoothstep(29, 34, lat));
  return mix(colour, kTundra, smoothstep(60, 69, lat));
}

// How much of the land below the treeline is wooded, by latitude: a lot in the tropics and the north, little between.
double woodedShare(double latDeg) {
  const double lat = std::abs(latDeg);
  const double dry = smoothstep(10, 20, lat) * (1 - smoothstep(29, 34, lat));
  return (1 - 0.9 * dry) * (1 - smoothstep(64, 70, lat));
}

}  // namespace

double treelineM(double latDeg) {
  static constexpr std::array<double, 10> kKnots{3900, 3900, 4000, 3700, 2600, 1550, 750, 50, -200, -200};
  return byLatitude(kKnots, latDeg);
}

double snowlineM(double latDeg) {
  static constexpr std::array<double, 10> kKnots{4800, 5000, 5600, 5300, 3900, 2850, 1750, 800, 100, -300};
  return byLatitude(kKnots, latDeg);
}

glm::vec3 groundColour(const GroundSample& ground) {
  const double noise = static_cast<double>(ground.broadNoise);
  const double grain = static_cast<double>(ground.grainNoise);
  // Water: below sea level, or at it and flat. Dry basins below it are few; what is not flat is taken for land.
  const double water = (1 - smoothstep(0.05, 0.7, ground.heightM)) *
                       (ground.heightM < -1 ? 1.0 : 1 - smoothstep(0.02, 0.06, ground.slope));
  const glm::vec3 sea = waterColour(std::max(0.0, -ground.heightM)) * static_cast<float>(1 + 0.015 * grain);
  const double ice = smoothstep(74, 79, std::abs(ground.latDeg) + 1.5 * noise);
  if (water >= 1) return mix(sea, kIce, ice);

  const double height = ground.heightM, slope = ground.slope;
  const double treeline = treelineM(ground.latDeg), snowline = snowlineM(ground.latDeg);

  glm::vec3 land = openColour(ground.latDeg, noise);
  land = mix(land, kPasture, 0.6 * smoothstep(0.15 * treeline, 0.45 * treeline, height) * woodedShare(ground.latDeg));
  // Woods stand on slopes and in the hills; flat lowland is mostly cleared.
  const double hilly =
      0.9 * smoothstep(0.06, 0.3, slope) + 0.55 * smoothstep(0.25 * treeline, 0.7 * treeline, height) - 0.45;
  const double wooded = woodedShare(ground.latDeg) * smoothstep(-0.3, 0.45, hilly + 0.75 * noise);
  // Beech and meadow edges below, dark spruce above, in stands.
  const double stand =
      smoothstep(-0.5, 0.6, 0.9 * noise + 0.35 * grain - 1.6 * (height / std::max(treeline, 300.0) - 0.5));
  const glm::vec3 forest =
      mix(mix(kForest, kLightForest, 0.75 * stand), kTaiga, smoothstep(52, 62, std::abs(ground.latDeg)));
  const double belowTrees = 1 - smoothstep(treeline - 150, treeline + 150, height + 160 * noise);
  land = mix(land, forest, 0.88 * wooded * belowTrees);
  // Above the trees: alpine meadow, then scree.
  const double band = std::max(snowline - treeline, 300.0);
  land = mix(land, kMeadow, (1 - belowTrees) * (1 - smoothstep(60, 68, std::abs(ground.latDeg))));
  const double bare = smoothstep(treeline + 0.2 * band, treeline + 0.75 * band, height + 200 * noise);
  land = mix(land, kScree, bare);
  // Rock where soil does not hold, from about 30 degrees above the trees and 40 below.
  const double steep = std::lerp(0.85, 0.55, 1 - belowTrees);
  land = mix(land, kRock, smoothstep(steep, steep + 0.35, slope + 0.08 * noise));
  // Snow stays longer in hollows and slides off what is steep.
  const double snow = smoothstep(snowline - 350, snowline + 250, height + 250 * noise - 1500 * ground.curvature) *
                      (1 - 0.85 * smoothstep(0.8, 1.3, slope));
  land = mix(land, kSnow, snow);
  // A beach, on coasts that are flat.
  const double beach =
      smoothstep(0.2, 0.8, height) * (1 - smoothstep(2.5, 5, height)) * (1 - smoothstep(0.03, 0.1, slope));
  land = mix(land, kBeach, 0.8 * beach * (1 - smoothstep(58, 66, std::abs(ground.latDeg))));

  // Ridges catch light from all of the sky, hollows and steep faces less: no sun is in this.
  const double open = std::clamp(5.0 * ground.curvature, -0.22, 0.2);
  const double shade = (1 - 0.16 * smoothstep(0.1, 1.2, slope)) * (1 + open) * (1 + (0.11 - 0.08 * snow) * grain);
  land = glm::clamp(land * static_cast<float>(shade), 0.0f, 1.0f);
  return mix(land, mix(sea, kIce, ice), water);
}

}  // namespace eye
