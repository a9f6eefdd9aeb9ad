// Hands out ranges of a pool, first fit. Neighbouring free ranges are joined when one is given back.
#pragma once

#include <cstdint>
#include <map>
#include <optional>

namespace eye {

class RangeAllocator {
 public:
  explicit RangeAllocator(uint32_t capacity);
  // The range's offset; nothing where no free range is long enough. `count` > 0.
  std::optional<uint32_t> allocate(uint32_t count);
  // Exactly what was allocated: anything else is a broken invariant.
  void release(uint32_t offset, uint32_t count);
  uint32_t capacity() const { return capacity_; }
  uint32_t used() const { return used_; }

 private:
  uint32_t capacity_, used_ = 0;
  std::map<uint32_t, uint32_t> free_;  // offset to length, no two adjacent
};

}  // namespace eye
