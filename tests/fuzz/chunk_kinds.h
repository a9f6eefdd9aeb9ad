// Which kinds of blobs the fuzzer of chunks knows, in the order of its first byte.
#pragma once

#include <array>

#include "terrain/tile_key.h"

namespace eye::fuzz {

inline const std::array<TileKey, 3> kChunkKeys{TileKey::fromGrid(7, 0, 12, 3), TileKey::fromGrid(5, 1, 31, 0),
                                               TileKey::fromGrid(5, 6, 31, 0)};
inline constexpr int kTextureSize = 16;

}  // namespace eye::fuzz
