#include "pano/planar_depth.h"

#include <algorithm>
#include <cmath>

namespace eye {

double paperBufferValue(const PaperBuffer& buffer, double depthM) {
  const double n = buffer.nearM, f = buffer.farM;
  const double value = (f + n) / (2 * (f - n)) - f * n / ((f - n) * depthM) + 0.5;
  const double steps = std::ldexp(1.0, buffer.bits) - 1;
  return std::round(std::clamp(value, 0.0, 1.0) * steps) / steps;
}

double paperDepthM(const PaperBuffer& buffer, double bufferValue) {
  const double n = buffer.nearM, f = buffer.farM;
  const double normalised = 2 * bufferValue - 1;
  return 2 * f * n / (f + n - normalised * (f - n));
}

}  // namespace eye
