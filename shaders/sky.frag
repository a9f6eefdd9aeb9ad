// The sky, where no terrain is.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.h"
#include "shared/atmosphere.h"

layout(location = 0) in vec3 inRay_eye;

layout(location = 0) out vec4 outColour;

void main() { outColour = vec4(dithered(skyColour(normalize(inRay_eye)), gl_FragCoord.xy), 1.0); }
