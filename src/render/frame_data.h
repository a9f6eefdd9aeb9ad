// What the shaders are told of a frame, computed in double precision. Pure.
#pragma once

#include "render/renderer.h"
#include "shared/types.h"

namespace eye {

shader::FrameData frameData(const FrameInput& input);

// `textureSize`: side of a layer in texels; the outermost texels' centres lie on the edges of (s, t).
shader::DrawData drawData(const ChunkDraw& draw, const Vec3d& eyeEcefM, int textureSize);

}  // namespace eye
