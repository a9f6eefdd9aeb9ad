#include "pano/panorama.h"

namespace eye {

std::vector<int> skylineRows(const Panorama& panorama) {
  const PanoramaFrame& frame = panorama.frame;
  std::vector<int> rows(static_cast<size_t>(frame.widthPx), frame.heightPx);
  for (int row = frame.heightPx - 1; row >= 0; --row)
    for (int column = 0; column < frame.widthPx; ++column)
      if (!std::isnan(panorama.distanceM[frame.at(column, row)])) rows[static_cast<size_t>(column)] = row;
  return rows;
}

}  // namespace eye
