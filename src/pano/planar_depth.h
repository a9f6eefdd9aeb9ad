// Distances as paper 002 takes them: out of a depth buffer of fixed point with finite near and far planes. What comes
// back is the depth along the view's axis, not the range, and as coarse as the buffer's steps. For comparison.
#pragma once

namespace eye {

// The paper names none of these. 24 bits are what desktop GPUs gave an OpenGL window in its time.
struct PaperBuffer {
  double nearM = 1, farM = 200000;
  int bits = 24;
};

// What the buffer keeps of a point `depthM` along the axis, 0 to 1: z_b = (f+n) / (2(f-n)) - fn / ((f-n) z) + 1/2,
// rounded to its steps. (In the paper's signs z_e = -depthM.)
double paperBufferValue(const PaperBuffer& buffer, double depthM);
// The paper's way back: z_n = 2 z_b - 1, z = 2fn / (f + n - z_n (f - n)).
double paperDepthM(const PaperBuffer& buffer, double bufferValue);

}  // namespace eye
