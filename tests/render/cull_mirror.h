// The culling passes on the CPU, obviously right: from what the GPU's read, what they must have written. The maths is
// that of the shaders (shared/cull.h), the loops are plain.
#pragma once

#include "render/renderer.h"

namespace eye::test {

struct CullMirror {
  std::vector<float> pyramid;
  std::vector<uint32_t> fates;  // EYE_FATE_EARLY is the GPU's word: it depends on the frame before
};
CullMirror mirrorOf(const CullReadBack& gpu);

// How often the early or late commands draw each triangle, by candidate, in the band that draws it most often. Nothing
// where a command's indices are not those of clusters of one chunk, from its own candidate on.
using TriangleTimes = std::vector<std::vector<uint32_t>>;
std::optional<TriangleTimes> trianglesDrawn(const CullReadBack& gpu,
                                            std::vector<shader::DrawCommand> CullReadBack::BandDraws::*commands);

// The first triangle that is not drawn as the fates have it: empty where all are.
std::string wrongDraws(const CullReadBack& gpu);

}  // namespace eye::test
