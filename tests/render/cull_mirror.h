// The culling passes on the CPU, obviously right: from what the GPU's read, what they must have written. The maths is
// that of the shaders (shared/cull.h), the loops are plain.
#pragma once

#include "render/renderer.h"

namespace eye::test {

struct CullMirror {
  std::vector<float> pyramid;
  std::vector<uint32_t> fates;  // as the GPU's, with EYE_FATE_DRAWN
  std::vector<shader::DrawCommand> late;
};
// Takes everything but `pyramid`, `fates` and `late` from `gpu`.
CullMirror mirrorOf(const CullReadBack& gpu);

}  // namespace eye::test
