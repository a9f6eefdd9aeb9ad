// Which chunks may have their haze computed by vertex: those in whose triangles it is next to linear.
#pragma once

#include <span>
#include <vector>

#include "render/renderer.h"
#include "shared/types.h"

namespace eye {

// By vertex a pixel costs a CPU device a third of what it costs by pixel (terrain.frag, terrain_wide.frag).
enum class HazeBy { vertex, pixel };

// Bound on how far colours, 0 to 1, are off where haze is interpolated over edges of so many metres between `nearestM`
// and `farthestM` from the eye.
double hazeErrorByVertex(double edgeM, double nearestM, double farthestM, const shader::FrameData& frame);

HazeBy hazeOf(const ChunkDraw& draw, const Vec3d& eyeEcefM, const shader::FrameData& frame);

// The draws in two parts, each in the order that they had: first those with haze by vertex, as many as is returned.
size_t partByHaze(std::span<const ChunkDraw> draws, const Vec3d& eyeEcefM, const shader::FrameData& frame,
                  std::vector<ChunkDraw>& parted);

}  // namespace eye
