// The speed reference's pixels: as much arithmetic as terrain and haze take together, no texture.
#version 460

layout(location = 0) in vec2 place;
layout(location = 0) out vec4 colour;

void main() {
  vec2 z = place;
  for (int i = 0; i < 12; ++i) z = vec2(z.x * z.x - z.y * z.y, 2.0 * z.x * z.y) * 0.7 + place;
  colour = vec4(exp(-abs(z)), inversesqrt(1.0 + dot(z, z)), 1.0);
}
