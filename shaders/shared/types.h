// Structs that C++ writes and shaders read, in scalar layout. Every row is 16 bytes, so that the layouts agree.
#ifndef EYE_SHADERS_TYPES_H
#define EYE_SHADERS_TYPES_H

#include "shared/config.h"

#ifdef __cplusplus
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
namespace eye::shader {
using glm::ivec3;
using glm::mat4;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using uint = uint32_t;
#endif

// One chunk as drawn in this frame. A vertex lies at (vertex + originMinusEyeCell) * stepM - eyeFractionM from the eye,
// in metres along the ecef axes.
struct DrawData {
  ivec3 originMinusEyeCell;
  float stepM;
  vec3 eyeFractionM;
  float skirtDepthM;
  vec3 up_ecef;
  uint textureLayer;
  vec4 outward_ecef[4];  // by Side, w unused
  vec2 textureScale, textureOffset;  // from (s, t) of the chunk to texture coordinates
};

struct FrameData {
  mat4 clipFromEcef;    // of positions relative to the eye: rotation and projection, no translation
  vec4 rayCentre_eye;   // the view ray through a point of the picture, z = 1: centre + ndc * half
  vec4 rayHalf_eye;     // z, w unused
  vec4 up_eye;          // w: the eye's distance from the Earth's centre, in Earth radii
  vec4 up_ecef;         // w: the eye's height above the ellipsoid, metres
  vec4 sun_eye;         // towards the sun; w: pixels that one metre covers at one metre's distance
  vec4 sun_ecef;        // w: near distance, metres
  vec4 sunLight;        // colour of direct light on terrain; w: the haze's extinction per metre at sea level
  vec4 skyLight;        // colour of the light of the whole sky; w: side of a texture in texels
  vec4 zenith;          // colour of an endlessly deep sky away from the sun; w: how much of the sky is lit, 0..1
  vec4 glow;            // colour that is added around the sun near the horizon; w: brightness of the sun's disc
  vec4 night;           // what the sky has at night; w: optical depth of a vertical column of haze in the sky
  vec4 background;      // w > 0: this flat colour instead of sky and haze
};

#ifdef __cplusplus
static_assert(sizeof(DrawData) == 128 && alignof(DrawData) == 4);
static_assert(offsetof(DrawData, eyeFractionM) == 16 && offsetof(DrawData, up_ecef) == 32);
static_assert(offsetof(DrawData, outward_ecef) == 48 && offsetof(DrawData, textureScale) == 112);
static_assert(sizeof(FrameData) == 64 + 12 * 16 && offsetof(FrameData, rayCentre_eye) == 64);
}  // namespace eye::shader
#endif

#endif
