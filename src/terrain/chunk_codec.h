// Chunk blobs: mesh (meshoptimizer's vertex and index codecs, then zstd) and imagery (RGB, filtered, then zstd).
// Decoders treat their input as hostile: any bytes give a chunk that is safe to draw, or an error.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/error.h"
#include "terrain/chunk.h"

namespace eye {

using Blob = std::vector<std::byte>;

Blob encodeMesh(const ChunkMesh& mesh);
// Checks counts, the boundary loop, that no index is out of range and that the clusters' runs cover the triangles.
Result<ChunkMesh> decodeMesh(std::span<const std::byte> blob, const TileKey& key);

// `rgb`: size * size * 3 bytes, row 0 at t = 0 (south), texel (i, j) centred on s = i / (size - 1), t = j / (size - 1).
Blob encodeImagery(std::span<const uint8_t> rgb, int size);
// RGBA8 (alpha 255) with its whole mip chain, levels behind one another, for upload.
Result<std::vector<uint8_t>> decodeImagery(std::span<const std::byte> blob, int size);
size_t mipChainBytes(int size);  // of decodeImagery's result
int mipLevels(int size);

}  // namespace eye
