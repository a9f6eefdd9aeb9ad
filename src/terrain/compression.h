// zstd with bounds: what chunk blobs are packed with.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "base/error.h"

namespace eye {

// The same bytes in give the same bytes out for one version of libzstd. Any thread.
std::vector<std::byte> compress(std::span<const std::byte> bytes);

// Fills `out` exactly; a frame that declares or gives any other size is badData, and nothing is allocated for it.
Result<void> decompress(std::span<const std::byte> packed, std::span<std::byte> out);

}  // namespace eye
