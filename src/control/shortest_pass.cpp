#include "control/shortest_pass.h"

#include <algorithm>

namespace eye {

double ShortestPass::observe(DepthMapChoice size, double passMs) {
  Newest& newest = bySize_[sizeIndex(size)];
  newest.ms[newest.count++ % newest.ms.size()] = passMs;
  const size_t known = std::min(newest.count, newest.ms.size());
  return *std::min_element(newest.ms.begin(), newest.ms.begin() + static_cast<std::ptrdiff_t>(known));
}

}  // namespace eye
