// Pictures out: PNG.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "base/error.h"

namespace eye {

// `quick`: a fifth larger in a third of the time.
enum class PngEffort { usual, quick };

// `rgba`: width * height * 4 bytes, row 0 at the top; alpha is dropped, the file is 8-bit RGB. The file appears whole
// or not at all. Thread: any.
Result<void> writePng(const std::string& path, std::span<const uint8_t> rgba, int widthPx, int heightPx,
                      PngEffort effort = PngEffort::usual);

}  // namespace eye
