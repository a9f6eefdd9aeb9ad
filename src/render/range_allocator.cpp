#include "render/range_allocator.h"

#include "base/error.h"

namespace eye {

RangeAllocator::RangeAllocator(uint32_t capacity) : capacity_(capacity) {
  if (capacity > 0) free_.emplace(0, capacity);
}

std::optional<uint32_t> RangeAllocator::allocate(uint32_t count) {
  EYE_CHECK(count > 0);
  for (auto range = free_.begin(); range != free_.end(); ++range) {
    const auto [offset, length] = *range;
    if (length < count) continue;
    free_.erase(range);
    if (length > count) free_.emplace(offset + count, length - count);
    used_ += count;
    return offset;
  }
  return std::nullopt;
}

void RangeAllocator::release(uint32_t offset, uint32_t count) {
  EYE_CHECK(count > 0 && count <= used_ && offset <= capacity_ - count);
  auto next = free_.lower_bound(offset);
  EYE_CHECK(next == free_.end() || offset + count <= next->first);
  if (next != free_.begin()) {
    const auto before = std::prev(next);
    EYE_CHECK(before->first + before->second <= offset);
    if (before->first + before->second == offset) {
      offset = before->first;
      count += before->second;
      used_ += before->second;  // taken off again below, with the rest
      free_.erase(before);
    }
  }
  used_ -= count;
  if (next != free_.end() && offset + count == next->first) {
    count += next->second;
    free_.erase(next);
  }
  free_.emplace(offset, count);
}

}  // namespace eye
