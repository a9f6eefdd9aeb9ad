#include "control/shortest_pass.h"

#include <algorithm>

namespace eye {

double ShortestPass::observe(DepthMapChoice size, double passMs) {
  if (size != size_) count_ = 0;
  size_ = size;
  newestMs_[count_++ % newestMs_.size()] = passMs;
  return *std::min_element(newestMs_.begin(), newestMs_.begin() + std::min(count_, newestMs_.size()));
}

}  // namespace eye
