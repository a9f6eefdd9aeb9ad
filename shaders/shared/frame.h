// The descriptor set as shaders see it. GLSL only.
#extension GL_EXT_scalar_block_layout : require

#include "shared/types.h"

layout(set = 0, binding = EYE_BIND_FRAME, scalar) uniform FrameBlock { FrameData frame; };

// Of a point of the picture, pixels; z = 1.
vec3 rayThrough(vec2 pixel) { return vec3(frame.ray_eye.xy + pixel * frame.ray_eye.zw, 1.0); }
