// The decisions of cull_early.comp and cull_late.comp by plain code, for devices that are a CPU: the same fates and the
// same clusters drawn, at a twentieth of what lavapipe takes for the shaders. Most of that is what lanes of a shader
// must do and a loop need not: go on when a visible texel is found, compute what only a neighbour asks for.
//
// The indices of what is drawn of a chunk are packed behind one another, so that it is one draw.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "shared/cull_types.h"

namespace eye {

// Of one frame, each as shaders/shared/cull_buffers.h has it.
struct HostCull {
  const shader::CullParams& params;
  std::span<const shader::CullChunk> chunks;
  std::span<const shader::CullCandidate> candidates;
  std::span<const shader::ClusterRecord> clusters;  // the resident ones
  std::span<uint32_t> visible;                      // of them
  std::span<const uint16_t> indices;                // of the resident chunks
  std::span<shader::DrawCommand> commands;          // one for each candidate, as is fates: the first drawn one's of a
                                                    // chunk draws all that are, the others nothing
  std::span<uint32_t> fates;
  std::span<uint16_t> packed;  // what the commands draw; room for every candidate's
};

// Commands for what was visible in the last frame and is in view; fates: EYE_FATE_EARLY where it is drawn. Returns how
// many indices are packed.
size_t cullEarly(const HostCull& cull);
// Commands for what shows and was not drawn early, packed behind the early ones' indices; all fates; visibility for the
// next frame.
void cullLate(const HostCull& cull, std::span<const float> pyramid, size_t earlyIndices);

}  // namespace eye
