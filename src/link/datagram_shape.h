// What a protocol's datagrams look like at the least: enough to tell garbage from them without reading it. Pure; the
// filter in link/udp_filter.h asks the same in the system.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace eye {

// The big-endian word at the offset, under the mask, is one of these.
struct WordRange {
  size_t offset;
  uint32_t mask, least, most;
};
constexpr WordRange wordIs(size_t offset, uint32_t mask, uint32_t value) {
  return {offset, mask, value, value};
}
// A big-endian double or float whose magnitude is at most the bound, no NaN among them. Of a double its upper half is
// looked at: those just above the bound pass too.
constexpr WordRange doubleWithin(size_t offset, double bound) {
  return {offset, 0x7fffffff, 0, static_cast<uint32_t>(std::bit_cast<uint64_t>(bound) >> 32)};
}
constexpr WordRange floatWithin(size_t offset, float bound) {
  return {offset, 0x7fffffff, 0, std::bit_cast<uint32_t>(bound)};
}

struct DatagramShape {
  size_t leastBytes, mostBytes;
  std::span<const WordRange> words;  // all of them, none beyond `leastBytes`
};

// False for every datagram that has none of the shapes.
bool looksLikeAny(std::span<const DatagramShape> shapes, std::span<const std::byte> datagram);

}  // namespace eye
