// Bounds-checked reading of binary data that is not trusted: packets, blobs, captures.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace eye {

// Reads values one after another in the byte order it was made with. A read past the end gives zero and makes ok()
// false for good, so a whole structure is read first and ok() asked once. The bytes must outlive the reader.
class ByteReader {
 public:
  ByteReader(std::span<const std::byte> bytes, std::endian order) : bytes_(bytes), order_(order) {}

  uint8_t u8() { return unsignedOf<uint8_t>(); }
  uint16_t u16() { return unsignedOf<uint16_t>(); }
  uint32_t u32() { return unsignedOf<uint32_t>(); }
  uint64_t u64() { return unsignedOf<uint64_t>(); }
  int8_t i8() { return static_cast<int8_t>(u8()); }
  int16_t i16() { return static_cast<int16_t>(u16()); }
  int32_t i32() { return static_cast<int32_t>(u32()); }
  int64_t i64() { return static_cast<int64_t>(u64()); }
  // IEEE 754; NaN and infinities come through, for the caller to reject.
  float f32() { return std::bit_cast<float>(u32()); }
  double f64() { return std::bit_cast<double>(u64()); }

  void skip(size_t count) { bytes(count); }
  // The next `count` bytes, without a copy; empty when there are fewer.
  std::span<const std::byte> bytes(size_t count) {
    if (!ok_ || count > remaining()) {
      ok_ = false;
      return {};
    }
    position_ += count;
    return bytes_.subspan(position_ - count, count);
  }

  // For formats that state their byte order themselves (CIGI, pcap).
  void setOrder(std::endian order) { order_ = order; }

  bool ok() const { return ok_; }
  size_t position() const { return position_; }
  size_t remaining() const { return bytes_.size() - position_; }

 private:
  // Whole and then turned round: a flood's datagrams are read with this.
  template <class T>
  T unsignedOf() {
    const auto taken = bytes(sizeof(T));
    T value = 0;
    if (taken.empty()) return value;
    std::memcpy(&value, taken.data(), sizeof(T));
    if (order_ == std::endian::native) return value;
    if constexpr (sizeof(T) == 2) return __builtin_bswap16(value);
    if constexpr (sizeof(T) == 4) return __builtin_bswap32(value);
    if constexpr (sizeof(T) == 8) return __builtin_bswap64(value);
    return value;
  }

  std::span<const std::byte> bytes_;
  size_t position_ = 0;
  std::endian order_;
  bool ok_ = true;
};

}  // namespace eye
