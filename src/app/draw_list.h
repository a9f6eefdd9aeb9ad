// From what was selected to what the renderer draws. Owner thread: render.
#pragma once

#include <vector>

#include "paging/lod_select.h"
#include "paging/terrain_cache.h"
#include "render/renderer.h"

namespace eye {

// `draws` keeps its memory from frame to frame.
void makeDrawList(const TerrainCache& cache, const Selection& selection, std::vector<ChunkDraw>& draws);

}  // namespace eye
