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

// How often the early or late commands draw each candidate's cluster, in the band that draws it most often. Empty where
// a command's indices are not whole clusters of one chunk behind one another, from its own candidate on.
std::vector<uint32_t> clustersDrawn(const CullReadBack& gpu,
                                    std::vector<shader::DrawCommand> CullReadBack::BandDraws::*commands);

}  // namespace eye::test
