#include "render/frame_data.h"

#include <algorithm>
#include <cmath>

#include "render/cloud_faces.h"
#include "render/sky_dome.h"

namespace eye {
namespace {

using glm::vec3;
using glm::vec4;

// Contrast falls to 5 % over the meteorological visibility (Koschmieder).
constexpr double kKoschmieder = 2.996;
// Real haze lies lower than the air (1.2 km against 8 km). It shows in the sky and from space, hardly between ridges,
// so there the haze counts as this share.
constexpr double kHazeShare = 0.15, kHazeShareFromSpace = 0.35;
// Optical depths of air, red, green, blue (Rayleigh at 680, 550, 440 nm). The sky takes them times 3.6: its colours are
// as displayed, where dim light is brighter.
const glm::dvec3 kAirDepth(0.046, 0.108, 0.265);
constexpr double kDisplayed = 3.6;
constexpr double kEarthRadiusM = EYE_EARTH_RADIUS_M;

double smoothstep(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

// By the visibility at the eye. Nothing of the sky shows through fog of less than 200 m, all of it through what is
// called mist or haze.
double fogAt(double visibilityM) {
  return 1 - smoothstep(std::log(200), std::log(5000), std::log(std::max(visibilityM, 1.0)));
}

glm::mat4 clipFromEcef(const View& view) {
  const Frustum& f = view.frustum;
  const double width = f.tanRight - f.tanLeft, height = f.tanTop - f.tanBottom;
  // Rows of the projection; eye: x right, y down, z forward; clip: y down, depth = near / z.
  glm::dmat4 clipFromEye(0.0);
  clipFromEye[0][0] = 2 / width;
  clipFromEye[2][0] = -(f.tanRight + f.tanLeft) / width;
  clipFromEye[1][1] = 2 / height;
  clipFromEye[2][1] = (f.tanTop + f.tanBottom) / height;
  clipFromEye[3][2] = f.nearM;
  clipFromEye[2][3] = 1;
  return glm::mat4(clipFromEye * glm::dmat4(view.eyeFromEcef));
}

// Colours by the sun's height. `rise`: sine of its elevation at the eye; `air`: density at the eye over the ground's.
void setLight(double rise, double air, double hazeDepth, shader::FrameData& frame) {
  // Air takes blue first: the lower the sun, the longer its way through it, the redder its light.
  const double column = air * EYE_LEVEL_COLUMN / (EYE_LEVEL_COLUMN * std::max(rise, 0.0) + 1);
  const glm::dvec3 through = glm::sqrt(glm::exp(-kAirDepth * column * 0.5));
  frame.sunLight = vec4(vec3(0.92 * through), frame.sunLight.w);
  // w as skyLit of shaders/shared/atmosphere.h.
  frame.skyLight = vec4(0.36, 0.39, 0.45, std::lerp(EYE_NIGHT_SKY, 1.0, smoothstep(-0.25, 0.10, rise)));

  const double low = (1 - smoothstep(0.0, 0.35, std::abs(rise))) * air;
  const glm::dvec3 byDay(0.80, 0.90, 1.02), byDusk(0.70, 0.65, 0.74);
  const glm::dvec3 deepSky = glm::mix(byDay, byDusk, low);
  const glm::dvec3 glow = glm::mix(glm::dvec3(0.22, 0.19, 0.13), glm::dvec3(0.50, 0.26, 0.06), low);
  const glm::dvec3 airDepth = kAirDepth * kDisplayed + hazeDepth;
  const glm::dvec3 atHorizon = 1.0 - glm::exp(-airDepth * double(EYE_LEVEL_COLUMN));
  frame.airDepth = vec4(vec3(airDepth), 0.0f);
  frame.deepSky = vec4(vec3(deepSky), 0.0f);
  frame.glow = vec4(vec3(glow), 1.0f);
  frame.horizon = vec4(vec3(deepSky * atHorizon), 0.0f);
  frame.horizonGlow = vec4(vec3(glow * atHorizon.g), 0.0f);
}

}  // namespace

shader::FrameData frameData(const FrameInput& input) {
  const View& view = input.view;
  const Frustum& f = view.frustum;
  const Geodetic eye = geodeticFromEcef(view.eyeEcefM);
  const Vec3d upEcef = upAt(eye.latDeg, eye.lonDeg);
  const Vec3d sunEcef = glm::normalize(input.lighting.sunDirectionEcef);
  const double radiusM = kEarthRadiusM + eye.altM;
  const double atGround = kKoschmieder / std::max(input.lighting.visibilityM, 1.0);
  const double fromSpace = smoothstep(20000, EYE_AIR_TOP_M, eye.altM);
  // In front of a flat background there is no haze either.
  const double extinction = input.background ? 0 : atGround * (1 + (kHazeShareFromSpace - 1) * fromSpace);
  const auto density = [](double heightM) { return std::exp(-std::max(heightM, 0.0) / EYE_AIR_SCALE_M); };

  shader::FrameData frame;
  frame.clipFromEcef = clipFromEcef(view);
  frame.ray_eye =
      vec4(f.tanLeft, -f.tanTop, (f.tanRight - f.tanLeft) / view.widthPx, (f.tanTop - f.tanBottom) / view.heightPx);
  frame.up_eye = vec4(vec3(view.eyeFromEcef * upEcef), static_cast<float>(radiusM / kEarthRadiusM));
  frame.up_ecef = vec4(vec3(upEcef), static_cast<float>(eye.altM));
  frame.sun_eye = vec4(vec3(view.eyeFromEcef * sunEcef), static_cast<float>(density(eye.altM)));
  frame.sun_ecef =
      vec4(vec3(sunEcef), static_cast<float>(std::exp(-std::min(eye.altM, EYE_AIR_TOP_M) / EYE_AIR_SCALE_M)));
  frame.domeAhead_ecef = vec4(vec3(domeAhead(upEcef)), 0.0f);
  frame.sunLight.w = static_cast<float>(extinction);
  setLight(glm::dot(upEcef, sunEcef), density(eye.altM), kHazeShare * atGround * EYE_AIR_SCALE_M, frame);
  // In fog the whole sky is the fog's, and no sun or star shows.
  const double fog = input.background ? 0 : fogAt(input.lighting.visibilityM / density(eye.altM));
  frame.airDepth.w = static_cast<float>(fog);
  frame.glow.w *= static_cast<float>(1 - fog);
  // Under clouds the sun shines neither on the ground nor into the haze.
  const float sunThrough = static_cast<float>(sunThroughClouds(input.lighting.clouds, eye.altM));
  for (vec4* light : {&frame.sunLight, &frame.horizonGlow}) *light = vec4(vec3(*light) * sunThrough, light->w);
  return frame;
}

shader::DrawData drawData(const ChunkDraw& draw, const Vec3d& eyeEcefM, int textureSize) {
  shader::DrawData data;
  const Vec3d eyeSteps = eyeEcefM / draw.stepM;
  const Vec3d eyeCell = glm::floor(eyeSteps);
  const Vec3d offset = Vec3d(draw.originLattice) - eyeCell;  // exact: both are integers below 2^53
  const double farthest = std::max({std::abs(offset.x), std::abs(offset.y), std::abs(offset.z)});
  // Beyond 2^30 steps, vertices included, integers would overflow; there a float is exact to a ten-millionth of a
  // radian.
  if (farthest < double(1 << 30)) {
    data.originMinusEyeCell = glm::ivec3(offset);
    data.eyeFractionM = vec3((eyeSteps - eyeCell) * draw.stepM);
  } else {
    data.originMinusEyeCell = glm::ivec3(0);
    data.eyeFractionM = vec3(eyeEcefM - ecefFromLattice(draw.originLattice, draw.stepM));
  }
  data.stepM = static_cast<float>(draw.stepM);
  data.skirtDepthM = 0;  // the records of skirts have their own
  data.upEcef = draw.upEcef;
  data.textureLayer = draw.textureLayer;
  for (size_t side = 0; side < 4; ++side) data.outwardEcef[side] = vec4(draw.outwardEcef[side], 0.0f);
  const float texels = static_cast<float>(textureSize);
  const float shrink = (texels - 1) / texels;
  data.textureScale = draw.textureScale * shrink;
  data.textureOffset = draw.textureOffset * shrink + 0.5f / texels;
  return data;
}

}  // namespace eye
