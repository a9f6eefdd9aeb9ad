#include "render/depth_pyramid.h"

#include <algorithm>

#include "base/error.h"
#include "shared/cull.h"

namespace eye {
namespace {

// to = min(to, from), texel by texel.
void takeFarther(std::span<float> to, const float* from) {
  for (size_t i = 0; i < to.size(); ++i) to[i] = std::min(to[i], from[i]);
}

}  // namespace

PyramidLayout pyramidLayout(glm::ivec2 mapPx) {
  PyramidLayout layout;
  for (glm::ivec2 size = mapPx;; size = (size + 1) / 2) {
    EYE_CHECK(layout.levels < EYE_MAX_DEPTH_LEVELS);
    layout.offset[static_cast<size_t>(layout.levels++)] = static_cast<int32_t>(layout.texels);
    layout.texels += static_cast<size_t>(size.x) * static_cast<size_t>(size.y);
    if (size == glm::ivec2(1)) return layout;
  }
}

void DepthPyramid::build(std::span<const float> depth, glm::ivec2 picturePx, glm::ivec2 mapPx,
                         std::span<float> pyramid) {
  const auto width = static_cast<size_t>(picturePx.x);
  farthestInRows_.resize(width);
  columns_.resize(static_cast<size_t>(mapPx.x));  // divisions would take longer than all else
  for (int x = 0; x < mapPx.x; ++x) columns_[static_cast<size_t>(x)] = shader::pixelSpan(x, mapPx.x, picturePx.x);
  float* to = pyramid.data();
  // The finest level: the rows that a texel touches first, whole rows at a time, then its columns.
  for (int y = 0; y < mapPx.y; ++y) {
    const glm::ivec2 rows = shader::pixelSpan(y, mapPx.y, picturePx.y);
    const float* row = depth.data() + static_cast<size_t>(rows.x) * width;
    std::copy_n(row, width, farthestInRows_.begin());
    for (int next = rows.x + 1; next <= rows.y; ++next) takeFarther(farthestInRows_, row += width);
    const float* farthest = farthestInRows_.data();
    for (const glm::ivec2& columns : columns_) {
      float value = farthest[columns.x];
      for (int x = columns.x + 1; x <= columns.y; ++x) value = std::min(value, farthest[x]);
      *to++ = value;
    }
  }
  const PyramidLayout layout = pyramidLayout(mapPx);
  for (int level = 1; level < layout.levels; ++level) {
    const glm::ivec2 size = shader::levelSize(mapPx, level), finer = shader::levelSize(mapPx, level - 1);
    const float* from = pyramid.data() + layout.offset[static_cast<size_t>(level - 1)];
    for (int y = 0; y < size.y; ++y) {
      const float* top = from + static_cast<std::ptrdiff_t>(2 * y) * finer.x;
      const float* bottom = from + static_cast<std::ptrdiff_t>(std::min(2 * y + 1, finer.y - 1)) * finer.x;
      const int pairs = finer.x / 2;
      for (int x = 0; x < pairs; ++x)
        to[x] = std::min(std::min(top[2 * x], top[2 * x + 1]), std::min(bottom[2 * x], bottom[2 * x + 1]));
      if (pairs < size.x) to[pairs] = std::min(top[finer.x - 1], bottom[finer.x - 1]);
      to += size.x;
    }
  }
}

}  // namespace eye
