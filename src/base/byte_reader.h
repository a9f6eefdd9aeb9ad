// Bounds-checked reading of binary data that is not trusted: packets, blobs, captures.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace eye {

// Reads values one after another in the byte order it was made with. A read past the end gives zero and makes ok()
// false for good, so a whole structure is read first and ok() asked once. The bytes must outlive the reader.
class ByteReader {
 public:
  ByteReader(std::span<const std::byte> bytes, std::endian order) : bytes_(bytes), order_(order) {}

  uint8_t u8() { return static_cast<uint8_t>(unsignedOf(1)); }
  uint16_t u16() { return static_cast<uint16_t>(unsignedOf(2)); }
  uint32_t u32() { return static_cast<uint32_t>(unsignedOf(4)); }
  uint64_t u64() { return unsignedOf(8); }
  int8_t i8() { return static_cast<int8_t>(u8()); }
  int16_t i16() { return static_cast<int16_t>(u16()); }
  int32_t i32() { return static_cast<int32_t>(u32()); }
  int64_t i64() { return static_cast<int64_t>(u64()); }
  // IEEE 754; NaN and infinities come through, for the caller to reject.
  float f32() { return std::bit_cast<float>(u32()); }
  double f64() { return std::bit_cast<double>(u64()); }

  void skip(size_t count) { bytes(count); }
  // The next `count` bytes, without a copy; empty when there are fewer.
  std::span<const std::byte> bytes(size_t count);

  // For formats that state their byte order themselves (CIGI, pcap).
  void setOrder(std::endian order) { order_ = order; }

  bool ok() const { return ok_; }
  size_t position() const { return position_; }
  size_t remaining() const { return bytes_.size() - position_; }

 private:
  uint64_t unsignedOf(size_t count);

  std::span<const std::byte> bytes_;
  size_t position_ = 0;
  std::endian order_;
  bool ok_ = true;
};

}  // namespace eye
