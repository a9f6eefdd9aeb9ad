#include "render/triangle_cull.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace eye {
namespace {

// How far a corner may be drawn from where it is computed here: the rasteriser rounds to 1/256 of a pixel, and floats
// of another order of operations differ by a thousandth.
constexpr float kSnapPx = 1.0f / 128;
// A triangle that may cover more is taken for visible, as nearly all such are.
constexpr int kMostPixels = 256;
// Behind the near plane, or so close before it that rounding may put it there.
constexpr float kNearDepth = 0.999f, kBehind = 2;
// Corners farther from each other are not known to the snap in floats.
constexpr float kWidestPx = 16384;

}  // namespace

TriangleCull::TriangleCull(const shader::CullParams& params, std::span<const float> depth, bool atCentres)
    : params_(params),
      depth_(depth),
      widePx_(static_cast<float>(params.picturePx.x)),
      highPx_(static_cast<float>(params.picturePx.y)),
      centrePx_(atCentres ? 0.5f : 0.0f),
      handed_(glm::dot(glm::cross(params.clipX_ecef, params.clipY_ecef), params.clipW_ecef) < 0 ? -1.0f : 1.0f) {}

void TriangleCull::place(const VertexFrame& frame, std::span<const ChunkVertex> vertices) {
  // In doubles up to the projection: a vertex close to the eye may be far from its chunk's origin.
  const glm::dvec3 rowX(params_.clipX_ecef), rowY(params_.clipY_ecef), rowW(params_.clipW_ecef);
  const glm::dvec3 stepX = rowX * frame.stepM, stepY = rowY * frame.stepM, stepW = rowW * frame.stepM;
  const glm::dvec3 origin_clip(glm::dot(rowX, frame.originM), glm::dot(rowY, frame.originM),
                               glm::dot(rowW, frame.originM));
  const double halfX = 0.5 * params_.picturePx.x, halfY = 0.5 * params_.picturePx.y, nearM = params_.nearM;
  corners_.resize(vertices.size());
  for (size_t i = 0; i < vertices.size(); ++i) {
    const glm::dvec3 at(vertices[i].x, vertices[i].y, vertices[i].z);
    const double w = origin_clip.z + glm::dot(stepW, at), perW = 1 / w;
    corners_[i] = {.xPx = static_cast<float>(((origin_clip.x + glm::dot(stepX, at)) * perW + 1) * halfX),
                   .yPx = static_cast<float>(((origin_clip.y + glm::dot(stepY, at)) * perW + 1) * halfY),
                   .depth = w > nearM ? static_cast<float>(nearM * perW) : kBehind};
  }
}

TriangleFates TriangleCull::fatesOf(std::span<const uint16_t> indices) const {
  TriangleFates fates;
  if (indices.size() > 3 * std::numeric_limits<TriangleBits>::digits) return {.visible = kAllTriangles};
  for (size_t t = 0; 3 * t < indices.size(); ++t) {
    const Fate fate = fateOf(corners_[indices[3 * t]], corners_[indices[3 * t + 1]], corners_[indices[3 * t + 2]]);
    fates.visible |= TriangleBits{fate == Fate::visible} << t;
    fates.occluded += fate == Fate::occluded;
  }
  return fates;
}

TriangleCull::Fate TriangleCull::fateOf(const Corner& a, const Corner& b, const Corner& c) const {
  const float nearest = std::max(std::max(a.depth, b.depth), c.depth);
  const float left = std::min(std::min(a.xPx, b.xPx), c.xPx), right = std::max(std::max(a.xPx, b.xPx), c.xPx);
  const float top = std::min(std::min(a.yPx, b.yPx), c.yPx), bottom = std::max(std::max(a.yPx, b.yPx), c.yPx);
  if (nearest > kNearDepth || right - left + bottom - top > kWidestPx) return Fate::visible;
  // Counterclockwise is clockwise where y goes down: front faces have a negative area. Corners moved by the snap change
  // it by no more than twice the sides' lengths times that.
  const float twiceArea = handed_ * ((b.xPx - a.xPx) * (c.yPx - a.yPx) - (c.xPx - a.xPx) * (b.yPx - a.yPx));
  if (twiceArea > 4 * kSnapPx * (right - left + bottom - top + 1)) return Fate::elsewhere;
  if (right < -kSnapPx || bottom < -kSnapPx || left > widePx_ + kSnapPx || top > highPx_ + kSnapPx)
    return Fate::elsewhere;
  // Pixels that may be covered: those whose centres lie within or, with more samples, any that it touches. The numbers
  // that are cut to integers are not negative, or so little that 0 will do.
  const float first = centrePx_ - kSnapPx, last = kSnapPx - centrePx_;
  const glm::ivec2 low(static_cast<int>(std::max(left + first, 0.0f)), static_cast<int>(std::max(top + first, 0.0f)));
  const glm::ivec2 high(static_cast<int>(std::min(right + last, widePx_ - 1)),
                        static_cast<int>(std::min(bottom + last, highPx_ - 1)));
  if (low.x > high.x || low.y > high.y) return Fate::elsewhere;
  if ((high.x - low.x + 1) * (high.y - low.y + 1) > kMostPixels) return Fate::visible;
  // Depth is a plane over the picture; corners moved by the snap raise it by its slope. Of a sliver, which has none to
  // speak of, nothing is known.
  const float depthB = b.depth - a.depth, depthC = c.depth - a.depth;
  const float slopes = std::abs(depthB * (c.yPx - a.yPx) - depthC * (b.yPx - a.yPx)) +
                       std::abs(depthC * (b.xPx - a.xPx) - depthB * (c.xPx - a.xPx));
  const float limit = nearest * EYE_DEPTH_FACTOR + 2 * kSnapPx * slopes / std::abs(twiceArea);
  return isBehindAll(limit, low, high) ? Fate::occluded : Fate::visible;
}

bool TriangleCull::isBehindAll(float depth, glm::ivec2 low, glm::ivec2 high) const {
  const float* row = depth_.data() + static_cast<std::ptrdiff_t>(low.y) * params_.picturePx.x;
  for (int y = low.y; y <= high.y; ++y, row += params_.picturePx.x)
    for (int x = low.x; x <= high.x; ++x)
      if (!(depth < row[x])) return false;
  return true;
}

}  // namespace eye
