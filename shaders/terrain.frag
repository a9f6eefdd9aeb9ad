// Terrain: imagery, light, haze.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.h"
#include "shared/atmosphere.h"

layout(set = 0, binding = EYE_BIND_TEXTURES) uniform sampler2DArray textures;

layout(location = 0) in vec2 inTexture;
layout(location = 1) in vec4 inLight;
layout(location = 2) in vec3 inPosition_ecef;
layout(location = 3) flat in uint inLayer;

layout(location = 0) out vec4 outColour;

void main() {
  vec3 ground = texture(textures, vec3(inTexture, float(inLayer))).rgb;
  vec3 colour = ground * (frame.sunLight.rgb * inLight.x + frame.skyLight.rgb * inLight.y);
  float perM = inversesqrt(dot(inPosition_ecef, inPosition_ecef));
  float haze = 1.0 - exp(-inLight.z / perM);
  vec3 seen = mix(colour, hazeColour(dot(inPosition_ecef, frame.sun_ecef.xyz) * perM, inLight.w), haze);
  outColour = vec4(dithered(seen, gl_FragCoord.xy), 1.0);
}
