#include "render/frame_data.h"

#include <algorithm>
#include <cmath>

namespace eye {
namespace {

using glm::vec3;
using glm::vec4;

// Contrast falls to 5 % over the meteorological visibility (Koschmieder).
constexpr double kKoschmieder = 2.996;
// Haze lies lower than the air (1.2 km against 8 km), which shows in the sky but hardly between low ridges.
constexpr double kSkyHazeShare = 0.15;
constexpr double kEarthRadiusM = EYE_EARTH_RADIUS_M;

double smoothstep(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
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

// Colours as displayed, by the sun's height. `rise`: sine of its elevation; `air`: the eye's air density over the
// ground's.
void setLight(double rise, double air, double dipRad, shader::FrameData& frame) {
  // Air takes blue first: the lower the sun, the longer its way through it, the redder its light.
  const double column = air * EYE_LEVEL_COLUMN / (EYE_LEVEL_COLUMN * std::max(rise, 0.0) + 1);
  const glm::dvec3 through = glm::sqrt(glm::exp(-glm::dvec3(0.046, 0.108, 0.265) * column * 0.5));
  const double lit = smoothstep(-0.25, 0.10, rise + dipRad);
  const double low = 1 - smoothstep(0.0, 0.35, std::abs(rise));
  frame.sunLight = vec4(vec3(0.92 * through), frame.sunLight.w);
  frame.skyLight = vec4(vec3(0.36f, 0.39f, 0.45f), frame.skyLight.w);
  const glm::dvec3 skyByDay(0.76, 0.85, 0.95), skyByDusk(0.66, 0.60, 0.66);
  frame.zenith = vec4(vec3(glm::mix(skyByDay, skyByDusk, low) * lit), static_cast<float>(lit));
  const double dusk = smoothstep(-0.20, -0.02, rise + dipRad);
  const glm::dvec3 glow = glm::mix(glm::dvec3(0.22, 0.19, 0.13), glm::dvec3(0.50, 0.26, 0.06), low * air);
  frame.glow = vec4(vec3(glow * dusk), 1.0f);
  frame.night = vec4(0.035f, 0.045f, 0.08f, frame.night.w);
}

}  // namespace

shader::FrameData frameData(const FrameInput& input, int textureSize) {
  const View& view = input.view;
  const Frustum& f = view.frustum;
  const Geodetic eye = geodeticFromEcef(view.eyeEcefM);
  const Vec3d upEcef = upAt(eye.latDeg, eye.lonDeg);
  const Vec3d sunEcef = glm::normalize(input.lighting.sunDirectionEcef);
  const double radiusM = kEarthRadiusM + eye.altM;
  const double extinction = kKoschmieder / std::max(input.lighting.visibilityM, 1.0);

  shader::FrameData frame;
  frame.clipFromEcef = clipFromEcef(view);
  frame.rayCentre_eye = vec4((f.tanLeft + f.tanRight) / 2, -(f.tanTop + f.tanBottom) / 2, 1, 0);
  frame.rayHalf_eye = vec4((f.tanRight - f.tanLeft) / 2, (f.tanTop - f.tanBottom) / 2, 0, 0);
  frame.up_eye = vec4(vec3(view.eyeFromEcef * upEcef), static_cast<float>(radiusM / kEarthRadiusM));
  frame.up_ecef = vec4(vec3(upEcef), static_cast<float>(eye.altM));
  frame.sun_eye = vec4(vec3(view.eyeFromEcef * sunEcef), static_cast<float>(pixelsPerRadian(view)));
  frame.sun_ecef = vec4(vec3(sunEcef), static_cast<float>(f.nearM));
  frame.sunLight.w = static_cast<float>(extinction);
  frame.skyLight.w = static_cast<float>(textureSize);
  frame.night.w = static_cast<float>(kSkyHazeShare * extinction * EYE_AIR_SCALE_M);
  const double air = std::exp(-std::max(eye.altM, 0.0) / EYE_AIR_SCALE_M);
  const double dipRad = std::acos(std::min(1.0, kEarthRadiusM / radiusM));
  setLight(glm::dot(upEcef, sunEcef), air, dipRad, frame);
  frame.background = input.background ? vec4(*input.background, 1.0f) : vec4(0.0f);
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
  data.skirtDepthM = draw.skirtDepthM;
  data.up_ecef = draw.upEcef;
  data.textureLayer = draw.textureLayer;
  for (size_t side = 0; side < 4; ++side) data.outward_ecef[side] = vec4(draw.outwardEcef[side], 0.0f);
  const float texels = static_cast<float>(textureSize);
  const float shrink = (texels - 1) / texels;
  data.textureScale = draw.textureScale * shrink;
  data.textureOffset = draw.textureOffset * shrink + 0.5f / texels;
  return data;
}

}  // namespace eye
