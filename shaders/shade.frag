// Once per pixel: samples the imagery, lights it, adds haze; where there is no terrain, the sky.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.h"
#include "shared/atmosphere.h"

layout(set = 0, binding = EYE_BIND_TEXEL_SIZES, scalar) readonly buffer TexelBlock { float texelSizesM[]; };
layout(set = 0, binding = EYE_BIND_TEXTURES) uniform sampler2DArray textures;
layout(set = 0, binding = EYE_BIND_DEPTH) uniform sampler2D depths;
layout(set = 0, binding = EYE_BIND_ATTRIBUTES) uniform usampler2D attributes;

layout(location = 0) in vec3 inRay_eye;
layout(location = 0) out vec4 outColour;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float depth = texelFetch(depths, pixel, 0).x;
  uvec2 packed = texelFetch(attributes, pixel, 0).xy;
  float perZ = inversesqrt(dot(inRay_eye, inRay_eye));
  vec3 ray_eye = inRay_eye * perZ;

  // The neighbours' texture coordinates, for the size of a pixel on the texture: before any branch.
  uint layer = packed.y & (EYE_MAX_LAYERS - 1);
  vec2 place = unpackUnorm2x16(packed.x);
  vec2 perX = dFdx(place), perY = dFdy(place);
  bool oneLayer = dFdx(float(layer)) == 0.0 && dFdy(float(layer)) == 0.0;

  if (depth <= 0.0) {
    vec3 sky = frame.background.w > 0.0 ? frame.background.rgb : dithered(skyColour(ray_eye), gl_FragCoord.xy);
    outColour = vec4(sky, 1.0);
    return;
  }

  float distanceM = frame.sun_ecef.w / (depth * perZ);
  // A pixel is at least as large as seen face on; where its neighbours show the same texture, as they say, but never
  // more than 2^1.5 times that: a slope seen edge on shall not smear.
  float faceOn = log2(distanceM / (frame.sun_eye.w * texelSizesM[layer]));
  float widest = max(dot(perX, perX), dot(perY, perY)) * frame.skyLight.w * frame.skyLight.w;
  float seen = 0.5 * log2(max(widest, 1e-12));
  float lod = oneLayer ? clamp(seen, faceOn, faceOn + 1.5) : faceOn;
  vec3 ground = textureLod(textures, vec3(place, float(layer)), lod).rgb;

  float sun = float((packed.y >> EYE_LAYER_BITS) & ((1u << EYE_SUN_BITS) - 1u)) / float((1u << EYE_SUN_BITS) - 1u);
  float sky = float(packed.y >> (EYE_LAYER_BITS + EYE_SUN_BITS)) / float((1u << EYE_SKY_BITS) - 1u);
  vec3 colour = ground * (frame.sunLight.rgb * sun + frame.skyLight.rgb * sky);
  if (frame.background.w <= 0.0) {
    float haze = hazeBetween(dot(ray_eye, frame.up_eye.xyz), distanceM);
    colour = mix(colour, horizonColour(dot(ray_eye, frame.sun_eye.xyz)), haze);
  }
  outColour = vec4(dithered(colour, gl_FragCoord.xy), 1.0);
}
