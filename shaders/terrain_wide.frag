// Terrain in wide triangles: haze by pixel. Few uniforms on purpose: each word of one costs a CPU device as much as a
// product.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.h"
#include "shared/atmosphere.h"

layout(set = 0, binding = EYE_BIND_TEXTURES) uniform sampler2DArray textures;

layout(location = 0) in vec2 inTexture;
layout(location = 1) in vec3 inLight;
layout(location = 2) in vec2 inHaze;
layout(location = 3) flat in uint inLayer;

layout(location = 0) out vec4 outColour;

void main() {
  vec3 ground = texture(textures, vec3(inTexture, float(inLayer))).rgb;
  vec3 colour = ground * inLight;
  // The pixel's ray and 1 / w = 1 / z give distance and direction: cheaper than to interpolate a position.
  vec3 ray_eye = rayThrough(gl_FragCoord.xy);
  float perRay = inversesqrt(dot(ray_eye, ray_eye));
  float seenThrough = exp2(-inHaze.x / (perRay * gl_FragCoord.w));
  vec3 haze = hazeColour(dot(ray_eye, frame.sun_eye.xyz) * perRay, inHaze.y);
  outColour = vec4(dithered(mix(haze, colour, seenThrough), gl_FragCoord.xy), 1.0);
}
