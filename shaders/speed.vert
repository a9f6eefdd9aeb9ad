// The speed reference's mesh: a grid of small triangles made of vertex indices alone. It draws the same work for ever:
// change it, and every stored baseline of eyepoint-bench compare with it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/speed.h"

layout(location = 0) out vec2 place;

void main() {
  const uint quad = gl_VertexIndex / 6, corner = gl_VertexIndex % 6;
  const uvec2 cell = uvec2(quad % EYE_SPEED_COLUMNS, quad / EYE_SPEED_COLUMNS);
  const uvec2 step = uvec2(corner == 1 || corner == 2 || corner == 4 ? 1 : 0, corner == 2 || corner >= 4 ? 1 : 0);
  place = vec2(cell + step) / vec2(EYE_SPEED_COLUMNS, EYE_SPEED_ROWS);
  gl_Position = vec4(place * 2.0 - 1.0, 0.5, 1.0);
}
