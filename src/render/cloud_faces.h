// Layers of cloud as one frame sees them, computed in double precision. Pure.
#pragma once

#include <vector>

#include "render/renderer.h"
#include "shared/cloud.h"
#include "shared/types.h"

namespace eye {

// The faces that the eye sees, the farthest first; none of a layer that it is within. `frame` as frameData makes it.
std::vector<shader::CloudFace> cloudFaces(const FrameInput& input, const shader::FrameData& frame);

// How much of the sun's light comes through the clouds above a height, as it shows: 1 where there are none.
double sunThroughClouds(const CloudLayers& clouds, double altM);

}  // namespace eye
