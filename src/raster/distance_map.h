// Distance maps out: a single-band Float32 GeoTIFF of slant ranges.
#pragma once

#include <span>
#include <string>

#include "base/error.h"

namespace eye {

// `rangeM`: width * height metres from the eye along each pixel's ray, row 0 at the top, NaN (also the file's NoData
// value) where there is sky. The file appears whole or not at all. Thread: any.
Result<void> writeDistanceMap(const std::string& path, std::span<const float> rangeM, int widthPx, int heightPx);

}  // namespace eye
