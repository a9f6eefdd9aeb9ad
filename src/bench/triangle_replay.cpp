#include "bench/triangle_replay.h"

namespace eye {
namespace {

void appendKept(const DrawnRun& run, TriangleFate least, const ChunkMesh& from, ChunkMesh& to) {
  for (size_t t = 0; t < run.fates.size(); ++t) {
    if (run.fates[t] < least) continue;
    const auto corner = from.indices.begin() + static_cast<std::ptrdiff_t>(run.firstIndex + 3 * t);
    to.indices.insert(to.indices.end(), corner, corner + 3);
  }
}

}  // namespace

TriangleReplay::TriangleReplay(TriangleReplay&& other) noexcept
    : renderer_(other.renderer_), uploaded_(std::move(other.uploaded_)), draws_(std::move(other.draws_)) {
  other.uploaded_.clear();
}

TriangleReplay::~TriangleReplay() {
  for (const GpuChunk& chunk : uploaded_) renderer_->release(chunk);
}

Result<TriangleReplay> TriangleReplay::create(Renderer& renderer, const FrameInput& input, const DrawnTriangles& drawn,
                                              TriangleFate least) {
  TriangleReplay replay(renderer);
  for (size_t r = 0; r < drawn.runs.size();) {
    const size_t i = drawn.runs[r].draw;
    ChunkDraw draw = input.draws[i];
    LoadedChunk kept;  // without texels: it shows the texture that the draw names
    kept.mesh.vertices = drawn.chunks[i]->mesh.vertices;
    draw.skirts = {};
    draw.skirtMask = 0;
    for (; r < drawn.runs.size() && drawn.runs[r].draw == i; ++r) {
      const auto first = static_cast<uint32_t>(kept.mesh.indices.size());
      appendKept(drawn.runs[r], least, drawn.chunks[i]->mesh, kept.mesh);
      const auto count = static_cast<uint32_t>(kept.mesh.indices.size()) - first;
      if (drawn.runs[r].skirtSide < 0) {
        kept.surfaceIndexCount = count;
      } else if (count > 0) {
        draw.skirts[static_cast<size_t>(drawn.runs[r].skirtSide)] = {first, count};
        draw.skirtMask |= static_cast<uint8_t>(1 << drawn.runs[r].skirtSide);
      }
    }
    if (kept.mesh.indices.empty()) continue;
    kept.mesh.clusters = {{.firstIndex = 0, .indexCount = static_cast<uint32_t>(kept.mesh.indices.size())}};
    const std::optional<GpuChunk> gpu = renderer.upload(kept);
    if (!gpu) return fail(ErrorKind::usage, "the GPU's pools have no room for the triangles of the floor");
    replay.uploaded_.push_back(*gpu);
    draw.gpu = *gpu;
    draw.gpu.indexCount = kept.surfaceIndexCount;
    replay.draws_.push_back(draw);
  }
  return replay;
}

}  // namespace eye
