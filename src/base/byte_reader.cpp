#include "base/byte_reader.h"

namespace eye {

std::span<const std::byte> ByteReader::bytes(size_t count) {
  if (!ok_ || count > remaining()) {
    ok_ = false;
    return {};
  }
  const auto taken = bytes_.subspan(position_, count);
  position_ += count;
  return taken;
}

uint64_t ByteReader::unsignedOf(size_t count) {
  const auto taken = bytes(count);
  uint64_t value = 0;
  for (size_t i = 0; i < taken.size(); ++i) {
    const size_t fromMostSignificant = order_ == std::endian::big ? i : taken.size() - 1 - i;
    value = value << 8 | std::to_integer<uint64_t>(taken[fromMostSignificant]);
  }
  return value;
}

}  // namespace eye
