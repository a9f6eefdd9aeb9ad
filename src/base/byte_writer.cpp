#include "base/byte_writer.h"

namespace eye {

void ByteWriter::put(uint64_t value, size_t count) {
  for (size_t i = 0; i < count; ++i) {
    const size_t byteFromLeast = order_ == std::endian::big ? count - 1 - i : i;
    bytes_.push_back(static_cast<std::byte>(value >> (8 * byteFromLeast) & 0xFF));
  }
}

}  // namespace eye
