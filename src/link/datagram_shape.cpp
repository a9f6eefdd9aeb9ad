#include "link/datagram_shape.h"

#include <algorithm>

#include "base/byte_reader.h"

namespace eye {
namespace {

bool isWithin(const WordRange& range, std::span<const std::byte> datagram) {
  const uint32_t word = ByteReader(datagram.subspan(range.offset), std::endian::big).u32() & range.mask;
  return word >= range.least && word <= range.most;
}

bool looksLike(const DatagramShape& shape, std::span<const std::byte> datagram) {
  return datagram.size() >= shape.leastBytes && datagram.size() <= shape.mostBytes &&
         std::ranges::all_of(shape.words, [&](const WordRange& range) { return isWithin(range, datagram); });
}

}  // namespace

bool looksLikeAny(std::span<const DatagramShape> shapes, std::span<const std::byte> datagram) {
  return std::ranges::any_of(shapes, [&](const DatagramShape& shape) { return looksLike(shape, datagram); });
}

}  // namespace eye
