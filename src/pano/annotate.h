// What a panorama has over its picture: ridge lines, a heading scale, names.
#pragma once

#include <span>

#include "base/error.h"
#include "pano/panorama.h"
#include "pano/peaks.h"

namespace eye {

// Darkens every pixel above which the distance leaps: the farther the leap, the darker.
void drawRidges(Panorama& panorama);
// `title`: one line in the corner. Of the visible peaks those are named that find room, the highest and nearest first.
// Returns how many.
Result<int> annotate(Panorama& panorama, std::span<const PanoramaPeak> peaks, const std::string& title);

}  // namespace eye
