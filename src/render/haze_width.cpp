#include "render/haze_width.h"

#include <algorithm>
#include <cmath>

#include "terrain/extent.h"

namespace eye {
namespace {

// Colours are displayed in 255 steps: one of them off, at worst.
constexpr double kToleratedError = 1.0 / 255;
// Greatest second derivative by the angle of glowShape in atmosphere.h: 0.35 * 4 + 0.65 * 16, towards the sun.
constexpr double kGlowCurvature = 11.8;

}  // namespace

// A function interpolated over a length l is off by l^2 / 8 of its second derivative at most.
double hazeErrorByVertex(double edgeM, double nearestM, double farthestM, const shader::FrameData& frame) {
  const double extinctionPerM = double{frame.sunLight.w};
  // What is seen through the haze, exp(-k d). The colours that it mixes differ by no more than 1.
  const double depth = extinctionPerM * edgeM;
  const double veil = depth * depth / 8;
  // The haze's glow about the sun, by direction, where there is haze: the nearer, the wider the edge and the less haze.
  const double brightest =
      std::max({double{frame.horizonGlow.r}, double{frame.horizonGlow.g}, double{frame.horizonGlow.b}});
  const double angle = edgeM / std::max(nearestM, 1e-3);
  const double reachM = std::min(std::max(nearestM, edgeM) + edgeM, farthestM);
  const double glow =
      brightest * std::min(kGlowCurvature * angle * angle / 8, 1.0) * (1 - std::exp(-extinctionPerM * reachM));
  return veil + glow;
}

HazeBy hazeOf(const ChunkDraw& draw, const Vec3d& eyeEcefM, const shader::FrameData& frame) {
  const Vec3d centreM = draw.box.centreEcefM - eyeEcefM;
  const double reachM = glm::length(draw.box.halfAxesEcefM[0] + draw.box.halfAxesEcefM[1] + draw.box.halfAxesEcefM[2]);
  const double errorOff = hazeErrorByVertex(double{draw.longestEdgeM}, distanceToBox(eyeEcefM, draw.box),
                                            glm::length(centreM) + reachM, frame);
  return errorOff <= kToleratedError ? HazeBy::vertex : HazeBy::pixel;  // so an unknown edge, infinite, is by pixel
}

size_t partByHaze(std::span<const ChunkDraw> draws, const Vec3d& eyeEcefM, const shader::FrameData& frame,
                  std::vector<ChunkDraw>& parted) {
  parted.assign(draws.begin(), draws.end());
  const auto byPixel = std::ranges::stable_partition(
      parted, [&](const ChunkDraw& draw) { return hazeOf(draw, eyeEcefM, frame) == HazeBy::vertex; });
  return parted.size() - byPixel.size();
}

}  // namespace eye
