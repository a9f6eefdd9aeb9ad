// Missing posts of a window of elevation: interpolated, or faded into another surface.
#pragma once

#include <cstdint>
#include <vector>

#include "base/error.h"

namespace eye {

// Over so many posts a source fades into the next one around its edges.
inline constexpr int kFadePosts = 16;
// Voids are interpolated from posts at most so far away.
inline constexpr int kFillPosts = 128;

struct PostWindow {
  int rows = 0, columns = 0;   // row 0 the southernmost
  std::vector<float> heightM;  // NaN where missing
  size_t index(int row, int column) const {
    return static_cast<size_t>(row) * static_cast<size_t>(columns) + static_cast<size_t>(column);
  }
};

// Interpolates the missing posts that `isVoid` flags, from valid posts within kFillPosts; what is farther stays
// missing. A post's result depends only on posts within that distance.
Result<void> interpolateVoids(PostWindow& window, std::vector<uint8_t> isVoid);

// For every missing post within kFadePosts of a valid one: the nearest valid post (an index into the window) and the
// weight of the source there, falling from 1 at a valid post to 0. `nearest` is -1 where no valid post is that near.
struct Fade {
  std::vector<int32_t> nearest;
  std::vector<float> weight;
};
Fade fadeAround(const PostWindow& window);

}  // namespace eye
