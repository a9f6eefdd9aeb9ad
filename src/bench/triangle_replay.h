// A picture drawn again from some of its triangles: the same pipeline, chunks in the same order, one draw a chunk, so
// that the difference of two replays is what the triangles between them cost. Owner thread: render.
#pragma once

#include "bench/drawn_triangles.h"

namespace eye {

class TriangleReplay {
 public:
  // The triangles whose fate is `least` or a later one. An error where the renderer's pools have no room: what was
  // uploaded is given back.
  static Result<TriangleReplay> create(Renderer& renderer, const FrameInput& input, const DrawnTriangles& drawn,
                                       TriangleFate least);
  TriangleReplay(TriangleReplay&& other) noexcept;
  TriangleReplay& operator=(TriangleReplay&&) = delete;
  ~TriangleReplay();

  std::span<const ChunkDraw> draws() const { return draws_; }

 private:
  explicit TriangleReplay(Renderer& renderer) : renderer_(&renderer) {}

  Renderer* renderer_;
  std::vector<GpuChunk> uploaded_;
  std::vector<ChunkDraw> draws_;
};

}  // namespace eye
