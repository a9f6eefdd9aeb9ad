// Where names stand over a panorama: slanting upwards from a line that rises from each summit, all over the skyline,
// none over another. Pure.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace eye {

struct LabelWish {
  double x = 0, y = 0;    // of the summit, pixels
  double lengthPx = 0;    // of the text
  double importance = 0;  // the greater is placed first
};

struct PlacedLabel {
  size_t wish = 0;
  glm::dvec2 foot{};    // where the text's baseline begins and the line from the summit ends
  double slopeRad = 0;  // of the baseline, upwards
};

struct LabelSpace {
  int widthPx = 0, heightPx = 0;
  double textHeightPx = 14;
  std::span<const int> skylineRows;        // by column
  std::span<const glm::dvec4> taken = {};  // rectangles x, y, x, y that are kept free
};

// Four corners of a label's text.
using LabelBox = std::array<glm::dvec2, 4>;
LabelBox labelBox(const LabelWish& wish, const PlacedLabel& label, double textHeightPx);
bool overlap(std::span<const glm::dvec2> convexA, std::span<const glm::dvec2> convexB);

std::vector<PlacedLabel> placeLabels(const LabelSpace& space, std::span<const LabelWish> wishes);

}  // namespace eye
