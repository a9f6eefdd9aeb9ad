// One triangle over the whole picture; each pixel has the depth of the cloud that it shows.
#version 460

void main() {
  vec2 ndc = vec2(gl_VertexIndex == 1 ? 3.0 : -1.0, gl_VertexIndex == 2 ? 3.0 : -1.0);
  gl_Position = vec4(ndc, 0.5, 1.0);
}
