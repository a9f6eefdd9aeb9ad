// Structs that C++ writes and shaders read.
#ifndef EYE_SHADERS_TYPES_H
#define EYE_SHADERS_TYPES_H

#include "shared/config.h"

#ifdef __cplusplus
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
namespace eye::shader {
using glm::mat4;
using glm::vec4;

// One chunk as drawn in this frame: attributes that change once an instance, which is once a draw. (Fetched from a
// storage buffer instead, the terrain cost 3 to 9 % more on lavapipe.) A vertex lies at
// (vertex + originMinusEyeCell) * stepM - eyeFractionM from the eye, in metres along the ecef axes.
struct DrawData {
  glm::ivec3 originMinusEyeCell;
  float stepM;
  glm::vec3 eyeFractionM;
  float skirtDepthM;
  glm::vec3 upEcef;
  uint32_t textureLayer;
  vec4 outwardEcef[4];                    // by Side, w unused
  glm::vec2 textureScale, textureOffset;  // from (s, t) of the chunk to texture coordinates
};
static_assert(sizeof(DrawData) == 128 && alignof(DrawData) == 4);
#endif

// Colours are as displayed, not linear. Scalar layout; every row is 16 bytes.
struct FrameData {
  mat4 clipFromEcef;    // of positions relative to the eye: rotation and projection, no translation
  vec4 ray_eye;         // the view ray through a point of the picture, z = 1: xy + pixel * zw
  vec4 up_eye;          // w: the eye's distance from the Earth's centre, in Earth radii
  vec4 up_ecef;         // w: the eye's height above the ellipsoid, metres
  vec4 sun_eye;         // towards the sun; w: density of the air at the eye, over the ground's
  vec4 sun_ecef;        // w: density of the air where a ray from above enters it (at most EYE_AIR_TOP_M up)
  vec4 sunLight;        // colour of direct light on terrain; w: the haze's extinction per metre at sea level
  vec4 skyLight;        // colour of the light of the whole sky; w: how far the haze about the eye is lit
  vec4 airDepth;        // optical depths, red to blue, of a vertical column of air and haze, from sea level; w: how far
                        // the eye stands in fog, 0 to 1: nothing but what is lit about it shows
  vec4 deepSky;         // colour of an endlessly deep sky by day, away from the sun
  vec4 glow;            // colour added to it towards the sun; w: brightness of the sun's disc
  vec4 horizon;         // deepSky as the horizon shows it
  vec4 horizonGlow;     // glow as the horizon shows it
  vec4 domeAhead_ecef;  // level direction of the sky dome's first meridian
};

#ifdef __cplusplus
static_assert(sizeof(FrameData) == 64 + 13 * 16 && offsetof(FrameData, ray_eye) == 64);
}  // namespace eye::shader
#endif

#endif
