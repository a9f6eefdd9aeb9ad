// The descriptor set as shaders see it. GLSL only.
#extension GL_EXT_scalar_block_layout : require

#include "shared/types.h"

layout(set = 0, binding = EYE_BIND_FRAME, scalar) uniform FrameBlock { FrameData frame; };
