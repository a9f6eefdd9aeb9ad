// What paper 004 (Table 3) reports by the viewpoint's distance from the Earth's surface: level of detail, blocks in the
// level, blocks visible after culling, frames a second (Core i3 with an NVS 3100M, Coin3D). It gives the culled shares
// of 94.77 and 98.98 % without their last digits, and neither field of view nor viewpoint.
#pragma once

#include <array>

namespace eye {

struct PublishedGlobe {
  double distanceKm;
  int level, blocks, visible;
  double culledShare, fps;
};

inline constexpr std::array<PublishedGlobe, 5> kPublishedGlobe{{
    {62763, 0, 8, 4, 0.500, 80},
    {34831, 1, 24, 6, 0.750, 65},
    {18746, 2, 88, 14, 0.841, 53},
    {9172, 3, 344, 18, 0.947, 51},
    {4936, 4, 1368, 14, 0.989, 52},
}};

}  // namespace eye
