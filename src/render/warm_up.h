// One small real frame through every pipeline: drivers compile at the first draw (15 to 75 ms each on lavapipe), and no
// frame of the flight shall pay for that.
#pragma once

#include "render/renderer.h"

namespace eye {

Result<void> warmUp(Renderer& renderer, const RendererOptions& options);

}  // namespace eye
