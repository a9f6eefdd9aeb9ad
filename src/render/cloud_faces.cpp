#include "render/cloud_faces.h"

#include <algorithm>
#include <cmath>

namespace eye {
namespace {

using glm::vec3;
using glm::vec4;

// Upwards, of a sky that is all covered: a 400th comes through.
constexpr double kMostOpticalDepth = 6;
// A layer comes and goes over this height at least, else the eye would see it vanish from one frame to the next.
constexpr double kLeastTransitionM = 30;
// Gaps close between these coverages: more is a sheet.
constexpr double kStillBroken = 0.85, kOneSheet = 0.97;
// Width of the pattern's largest heaps; the cells of the finer ones are a third and a ninth of it.
constexpr int kPatternM = 3000;
// Light that a closed layer leaves of the sun's, in displayed brightness.
constexpr double kSunThroughSheet = 0.15;
// Shares of sunlight and skylight that the top throws back, and that come through to the base of thin and of closed
// layers: white above, an overcast's grey below.
constexpr double kTopSun = 0.58, kTopSky = 1.0;
constexpr double kThinBaseSun = 0.42, kThinBaseSky = 1.15, kSheetBaseSun = 0.12, kSheetBaseSky = 1.2;

double smoothstep(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

// How far the eye is out of the layer, 0 at its face, 1 beyond the transition.
double outOf(double beyondM, double transitionM) {
  return smoothstep(0, std::max(transitionM, kLeastTransitionM), beyondM);
}

struct SeenLayer {
  const CloudLayer* layer;
  double faceM, beyondM;  // height of the face, distance of the eye's height from it
  bool fromBelow;
};

shader::CloudFace faceOf(const SeenLayer& seen, const View& view, double sunThere, const vec3& sun, const vec3& sky) {
  const CloudLayer& layer = *seen.layer;
  shader::CloudFace face;
  // The ellipsoid of that height: |scale * point| = 1 in units of its half axis at the equator.
  const double equatorM = kSemiMajorM + seen.faceM, poleM = kSemiMinorM + seen.faceM;
  const Vec3d scale(1, 1, equatorM / poleM);
  const Vec3d scaled = scale * view.eyeEcefM / equatorM;
  // Of the sign that its height says, however near the face is.
  const double above = std::max(std::abs(glm::dot(scaled, scaled) - 1), 1e-9);
  face.centre_eye =
      vec4(vec3(view.eyeFromEcef * (scale * scaled)), static_cast<float>(seen.fromBelow ? -above : above));
  const double opticalDepth = std::min(-std::log(std::max(1 - layer.coverage, 1e-9)), kMostOpticalDepth);
  const double there = outOf(seen.beyondM, seen.fromBelow ? layer.baseTransitionM : layer.topTransitionM);
  face.shape = vec4(Vec3d(1, scale.z * scale.z - 1, opticalDepth), there);

  const double sheet = smoothstep(0, kOneSheet, layer.coverage);
  const double sunPart = seen.fromBelow ? std::lerp(kThinBaseSun, kSheetBaseSun, sheet) : kTopSun;
  const double skyPart = seen.fromBelow ? std::lerp(kThinBaseSky, kSheetBaseSky, sheet) : kTopSky;
  face.sunPart = vec4(sun * static_cast<float>(sunPart * sunThere), static_cast<float>(equatorM));
  face.skyPart = vec4(sky * static_cast<float>(skyPart),
                      static_cast<float>(1 - smoothstep(kStillBroken, kOneSheet, layer.coverage)));

  const Vec3d cells = view.eyeEcefM / double(kPatternM), cell = glm::floor(cells);
  face.cell = glm::ivec4(glm::ivec3(glm::dvec3(cell)), kPatternM);
  const Vec3d within = cells - cell;
  face.x_eye = vec4(vec3(view.eyeFromEcef[0]), static_cast<float>(within.x));
  face.y_eye = vec4(vec3(view.eyeFromEcef[1]), static_cast<float>(within.y));
  face.z_eye = vec4(vec3(view.eyeFromEcef[2]), static_cast<float>(within.z));
  return face;
}

}  // namespace

double sunThroughClouds(const CloudLayers& clouds, double altM) {
  double through = 1;
  for (const CloudLayer& layer : clouds) {
    if (layer.coverage <= 0) continue;
    const double deepM = std::max(layer.topM - layer.baseM, 1.0);
    const double under = 1 - std::clamp((altM - layer.baseM) / deepM, 0.0, 1.0);
    through *= 1 - (1 - kSunThroughSheet) * layer.coverage * layer.coverage * under;
  }
  return through;
}

std::vector<shader::CloudFace> cloudFaces(const FrameInput& input, const shader::FrameData& frame) {
  const CloudLayers& clouds = input.lighting.clouds;
  const double eyeM = geodeticFromEcef(input.view.eyeEcefM).altM;
  std::vector<SeenLayer> seen;
  for (const CloudLayer& layer : clouds) {
    if (layer.coverage <= 0) continue;
    if (eyeM < layer.baseM) seen.push_back({&layer, layer.baseM, layer.baseM - eyeM, true});
    if (eyeM > layer.topM) seen.push_back({&layer, layer.topM, eyeM - layer.topM, false});
  }
  std::ranges::sort(seen, std::ranges::greater{}, &SeenLayer::beyondM);
  // What the frame has is the sun's light at the eye.
  const vec3 sun = vec3(frame.sunLight) / static_cast<float>(sunThroughClouds(clouds, eyeM));
  std::vector<shader::CloudFace> faces;
  for (const SeenLayer& layer : seen) {
    const double sunThere = sunThroughClouds(clouds, layer.layer->topM);
    faces.push_back(faceOf(layer, input.view, sunThere, sun, vec3(frame.skyLight)));
  }
  return faces;
}

}  // namespace eye
