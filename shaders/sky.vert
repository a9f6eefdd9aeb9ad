// One triangle over the whole picture, at the depth of nothing.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.h"

void main() {
  vec2 ndc = vec2(gl_VertexIndex == 1 ? 3.0 : -1.0, gl_VertexIndex == 2 ? 3.0 : -1.0);
  gl_Position = vec4(ndc, EYE_CLEAR_DEPTH, 1.0);
}
