// A star's spot: light that is added, fading towards its rim.
#version 460

layout(location = 0) in vec2 inFromCentre;
layout(location = 1) flat in float inBrightness;

layout(location = 0) out vec4 outColour;

void main() {
  float fade = max(1.0 - dot(inFromCentre, inFromCentre), 0.0);
  outColour = vec4(vec3(inBrightness * fade * fade), 0.0);
}
