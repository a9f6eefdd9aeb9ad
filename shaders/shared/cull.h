// The maths of culling, stated once: the compute shaders and the tests' CPU mirror compile this file. Every function
// is conservative: what it calls hidden has no pixel on the screen.
#ifndef EYE_SHADERS_CULL_H
#define EYE_SHADERS_CULL_H

#include "shared/cull_types.h"

#ifdef __cplusplus
namespace eye::shader {
#define EYE_FUNCTION inline
#define EYE_PRECISE
using glm::abs;
using glm::max;
using glm::min;
using std::sqrt;
#else
// Same order of operations as on the CPU, so that both decide alike.
#define EYE_FUNCTION
#define EYE_PRECISE precise
#endif

EYE_FUNCTION float sumOf(vec3 a, vec3 b) {
  EYE_PRECISE float sum = a.x * b.x + a.y * b.y;
  sum = sum + a.z * b.z;
  return sum;
}

// A cluster's oriented box relative to the eye, axes of half length.
struct CullBox {
  vec3 centre_ecef, x_ecef, y_ecef, z_ecef;
};

EYE_FUNCTION CullBox boxOf(CullChunk chunk, ClusterRecord cluster) {
  const float perStep = float(1.0 / 65535.0);
  vec3 low = vec3(float(cluster.boxMinXY & 65535u), float(cluster.boxMinXY >> 16), float(cluster.boxMinZMaxX & 65535u));
  vec3 high = vec3(float(cluster.boxMinZMaxX >> 16), float(cluster.boxMaxYZ & 65535u), float(cluster.boxMaxYZ >> 16));
  // -1 to 1 over the chunk's box: the middle is (low + high) / 65535 - 1, half the length (high - low) / 65535.
  EYE_PRECISE vec3 middle = (low + high) * perStep - vec3(1.0f);
  EYE_PRECISE vec3 half_ = (high - low) * perStep;
  CullBox box;
  EYE_PRECISE vec3 centre = chunk.centre_ecef + chunk.axisX_ecef * middle.x;
  centre = centre + chunk.axisY_ecef * middle.y;
  centre = centre + chunk.axisZ_ecef * middle.z;
  box.centre_ecef = centre;
  box.x_ecef = chunk.axisX_ecef * half_.x;
  box.y_ecef = chunk.axisY_ecef * half_.y;
  box.z_ecef = chunk.axisZ_ecef * half_.z;
  return box;
}

// Greatest value of a linear function over the box, given its values at the centre and along the half axes.
EYE_FUNCTION float greatestOver(float centre, vec3 axes) {
  EYE_PRECISE float reach = abs(axes.x) + abs(axes.y);
  reach = reach + abs(axes.z);
  return centre + reach;
}

// The box in clip space: (x, y, w) of its centre and of its half axes.
struct ClipBox {
  vec3 centre_clip, x_clip, y_clip, z_clip;
};

EYE_FUNCTION vec3 clipOf(CullParams params, vec3 v_ecef) {
  return vec3(sumOf(params.clipX_ecef, v_ecef), sumOf(params.clipY_ecef, v_ecef), sumOf(params.clipW_ecef, v_ecef));
}

EYE_FUNCTION ClipBox clipBoxOf(CullParams params, CullBox box) {
  ClipBox clip;
  clip.centre_clip = clipOf(params, box.centre_ecef);
  clip.x_clip = clipOf(params, box.x_ecef);
  clip.y_clip = clipOf(params, box.y_ecef);
  clip.z_clip = clipOf(params, box.z_ecef);
  return clip;
}

// Behind one of the planes: sides, moved outwards by a pixel, and near plane.
EYE_FUNCTION bool isOutsideFrustum(CullParams params, ClipBox b) {
  vec3 w = vec3(b.x_clip.z, b.y_clip.z, b.z_clip.z);
  if (greatestOver(b.centre_clip.z, w) < params.nearM) return true;
  float wideX = 1.0f + 2.0f / float(params.picturePx.x), wideY = 1.0f + 2.0f / float(params.picturePx.y);
  vec3 x = vec3(b.x_clip.x, b.y_clip.x, b.z_clip.x), y = vec3(b.x_clip.y, b.y_clip.y, b.z_clip.y);
  float xAt = b.centre_clip.x, yAt = b.centre_clip.y, wX = b.centre_clip.z * wideX, wY = b.centre_clip.z * wideY;
  return greatestOver(wX + xAt, w * wideX + x) < 0.0f || greatestOver(wX - xAt, w * wideX - x) < 0.0f ||
         greatestOver(wY + yAt, w * wideY + y) < 0.0f || greatestOver(wY - yAt, w * wideY - y) < 0.0f;
}

EYE_FUNCTION float signedByte(uint packed, int index) {
  return float(int(packed << (24 - 8 * index)) >> 24) * float(1.0 / 127.0);
}

// All triangles of the cluster turn their backs (sphere form, see meshoptimizer's documentation of its cones).
EYE_FUNCTION bool isBackFacing(CullBox box, uint cone) {
  float cutoff = signedByte(cone, 3);
  if (cutoff >= 1.0f) return false;
  vec3 axis = vec3(signedByte(cone, 0), signedByte(cone, 1), signedByte(cone, 2));
  float distanceM = sqrt(sumOf(box.centre_ecef, box.centre_ecef));
  EYE_PRECISE float radiusSquared = sumOf(box.x_ecef, box.x_ecef) + sumOf(box.y_ecef, box.y_ecef);
  radiusSquared = radiusSquared + sumOf(box.z_ecef, box.z_ecef);
  // The margin: a triangle all but edge-on may turn its front when the rasteriser rounds its corners to subpixels.
  EYE_PRECISE float limit = (cutoff + EYE_CONE_MARGIN) * distanceM + sqrt(radiusSquared);
  return sumOf(box.centre_ecef, axis) >= limit;
}

// What can be told without the depth map.
EYE_FUNCTION uint fateInView(CullParams params, CullBox box, ClipBox clip, uint cone) {
  if (isOutsideFrustum(params, clip)) return EYE_FATE_OUTSIDE;
  return isBackFacing(box, cone) ? EYE_FATE_BACK_FACING : EYE_FATE_VISIBLE;
}

// Where on the depth map a box lies and how near it comes.
struct MapRect {
  ivec2 low, high;  // texels of the finest level, both within
  float nearest;    // reversed-Z depth that no part of the box exceeds
  bool isKnown;     // false: the box reaches the near plane
};

EYE_FUNCTION MapRect mapRectOf(CullParams params, ClipBox b) {
  MapRect rect;
  EYE_PRECISE float reach = abs(b.x_clip.z) + abs(b.y_clip.z);
  reach = reach + abs(b.z_clip.z);
  float nearestW = b.centre_clip.z - reach;
  // The margins: depth is interpolated in floats at pixel centres, which may lie a subpixel outside of a triangle.
  EYE_PRECISE float marginW = nearestW - EYE_DEPTH_MARGIN * reach;
  rect.isKnown = marginW > params.nearM;
  rect.low = ivec2(0, 0);
  rect.high = ivec2(0, 0);
  rect.nearest = 1.0f;
  if (!rect.isKnown) return rect;
  rect.nearest = params.nearM * (1.0f / marginW) * EYE_DEPTH_FACTOR;
  vec2 least = vec2(1e9f, 1e9f), most = vec2(-1e9f, -1e9f);
  for (int corner = 0; corner < 8; ++corner) {
    float sx = (corner & 1) != 0 ? 1.0f : -1.0f, sy = (corner & 2) != 0 ? 1.0f : -1.0f,
          sz = (corner & 4) != 0 ? 1.0f : -1.0f;
    EYE_PRECISE vec3 at = b.centre_clip + b.x_clip * sx;
    at = at + b.y_clip * sy;
    at = at + b.z_clip * sz;
    float perW = 1.0f / at.z;
    vec2 ndc = vec2(at.x * perW, at.y * perW);
    least = min(least, ndc);
    most = max(most, ndc);
  }
  // In texels; half a picture's pixel of margin for the rasteriser's rounding.
  vec2 scale = vec2(float(params.mapPx.x), float(params.mapPx.y)) * 0.5f;
  vec2 margin = vec2(1.0f / float(params.picturePx.x), 1.0f / float(params.picturePx.y));
  vec2 last = vec2(float(params.mapPx.x - 1), float(params.mapPx.y - 1));
  EYE_PRECISE vec2 low = (least - margin + vec2(1.0f)) * scale;
  EYE_PRECISE vec2 high = (most + margin + vec2(1.0f)) * scale;
  low = min(max(low, vec2(0.0f)), last);
  high = min(max(high, vec2(0.0f)), last);
  rect.low = ivec2(int(low.x), int(low.y));
  rect.high = ivec2(int(high.x), int(high.y));
  return rect;
}

// Levels halve, rounding up: a texel covers two by two of the finer level, at the far edges perhaps fewer.
EYE_FUNCTION ivec2 levelSize(ivec2 mapPx, int level) {
  int more = (1 << level) - 1;
  return ivec2((mapPx.x + more) >> level, (mapPx.y + more) >> level);
}
EYE_FUNCTION ivec2 texelAt(ivec2 finest, int level) {
  return ivec2(finest.x >> level, finest.y >> level);
}

// Texels of a level that the rectangle touches.
EYE_FUNCTION int texelsOf(MapRect rect, int level) {
  ivec2 extent = texelAt(rect.high, level) - texelAt(rect.low, level);
  return (extent.x + 1) * (extent.y + 1);
}

// The finest level at which they are not too many. Terrain seen from low down is wide and flat, and its rectangles end
// where the sky begins: with the usual four texels, of 56 clusters hidden in a view over the Tatra none was found.
EYE_FUNCTION int levelOf(MapRect rect) {
  int level = 0;
  while (texelsOf(rect, level) > EYE_RECT_TEXELS) ++level;
  return level;
}

// First and last pixel of the picture that a texel of the finest level touches, along one axis.
EYE_FUNCTION ivec2 pixelSpan(int texel, int mapPx, int picturePx) {
  return ivec2(texel * picturePx / mapPx, ((texel + 1) * picturePx + mapPx - 1) / mapPx - 1);
}

#ifdef __cplusplus
}  // namespace eye::shader
#endif

#endif
