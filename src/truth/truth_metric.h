// How a rendered distance map compares with the truth.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "truth/ray_caster.h"

namespace eye::truth {

// What a pixel is, in the order of the colours of the error image.
enum class PixelVerdict : uint8_t {
  explained,
  tooNear,
  tooFar,
  skyBelowSkyline,  // sky drawn where the truth is terrain all around
  terrainAboveSkyline,
  notAssessed,  // the truth is unknown here or next to it
};

struct Comparison {
  std::vector<PixelVerdict> verdicts;  // row 0 on top
  int assessed = 0, explained = 0, skyBelowSkyline = 0, terrainAboveSkyline = 0, notAssessed = 0;
  double medianError = 0, p99Error = 0;  // relative, over the pixels that are terrain in both
  double explainedShare() const { return assessed > 0 ? static_cast<double>(explained) / assessed : 0; }
};

// A pixel is explained when its distance lies within the true distances of its 3x3 neighbourhood, widened by 0.1 %; a
// pixel of sky when some neighbour is truly sky. `renderedM`: metres along the ray, NaN where sky is drawn.
Comparison compare(const TruthImage& truth, std::span<const float> renderedM);

std::string summaryLine(const Comparison& comparison);

// One colour a verdict (grey, red, blue, magenta, orange, black), for a person to see where: RGBA rows from the top.
std::vector<uint8_t> errorPicture(const Comparison& comparison);

}  // namespace eye::truth
