// The dome's colours where no terrain is.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.h"
#include "shared/atmosphere.h"

layout(location = 0) in vec3 inColour;

layout(location = 0) out vec4 outColour;

void main() { outColour = vec4(dithered(inColour, gl_FragCoord.xy), 1.0); }
