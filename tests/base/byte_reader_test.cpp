#include "base/byte_reader.h"

#include <cmath>
#include <limits>

#include <catch2/catch.hpp>

#include "base/byte_writer.h"

namespace eye {
namespace {

std::vector<std::byte> bytesOf(std::initializer_list<int> values) {
  std::vector<std::byte> bytes;
  for (const int value : values) bytes.push_back(static_cast<std::byte>(value));
  return bytes;
}

TEST_CASE("a reader takes values in the byte order it is told") {
  const auto bytes = bytesOf({0x01, 0x02, 0x03, 0x04, 0x05, 0x06, 0x07, 0x08});
  ByteReader big(bytes, std::endian::big);
  CHECK(big.u8() == 0x01);
  CHECK(big.u16() == 0x0203);
  CHECK(big.u32() == 0x04050607);
  CHECK(big.remaining() == 1);
  CHECK(ByteReader(bytes, std::endian::big).u64() == 0x0102030405060708);
  CHECK(ByteReader(bytes, std::endian::little).u64() == 0x0807060504030201);

  ByteReader mixed(bytes, std::endian::big);
  CHECK(mixed.u16() == 0x0102);
  mixed.setOrder(std::endian::little);
  CHECK(mixed.u16() == 0x0403);
  CHECK(mixed.position() == 4);
}

TEST_CASE("known IEEE patterns and negative numbers are read") {
  const auto bytes = bytesOf({0xFE, 0xC0, 0x49, 0x0F, 0xDB, 0xFF, 0xFE});
  ByteReader reader(bytes, std::endian::big);
  CHECK(reader.i8() == -2);
  CHECK(reader.f32() == -3.14159274f);
  CHECK(reader.i16() == -2);
  CHECK(reader.ok());
}

TEST_CASE("a read past the end gives zero and fails for good") {
  const auto bytes = bytesOf({0xAA, 0xBB, 0xCC});
  ByteReader reader(bytes, std::endian::big);
  CHECK(reader.u16() == 0xAABB);
  CHECK(reader.u16() == 0);
  CHECK_FALSE(reader.ok());
  CHECK(reader.u8() == 0);  // one byte is left, but the structure is already broken
  CHECK(reader.bytes(0).empty());
  CHECK_FALSE(reader.ok());

  ByteReader overflow(bytes, std::endian::big);
  overflow.skip(1);
  overflow.skip(std::numeric_limits<size_t>::max());  // must not wrap round
  CHECK_FALSE(overflow.ok());
  CHECK(ByteReader({}, std::endian::big).u64() == 0);
}

TEST_CASE("what is written is read again, in both orders") {
  for (const std::endian order : {std::endian::big, std::endian::little}) {
    ByteWriter writer(order);
    writer.u8(0xFF);
    writer.i16(-12345);
    writer.u32(0xDEADBEEF);
    writer.i64(std::numeric_limits<int64_t>::min());
    writer.f32(-0.1f);
    writer.zeros(3);
    writer.f64(6378137.0001);
    writer.bytes(bytesOf({1, 2}));
    REQUIRE(writer.size() == 1 + 2 + 4 + 8 + 4 + 3 + 8 + 2);

    const std::vector<std::byte> bytes = writer.take();
    ByteReader reader(bytes, order);
    CHECK(reader.u8() == 0xFF);
    CHECK(reader.i16() == -12345);
    CHECK(reader.u32() == 0xDEADBEEF);
    CHECK(reader.i64() == std::numeric_limits<int64_t>::min());
    CHECK(reader.f32() == -0.1f);
    reader.skip(3);
    CHECK(reader.f64() == 6378137.0001);
    CHECK(std::to_integer<int>(reader.bytes(2)[1]) == 2);
    CHECK(reader.ok());
    CHECK(reader.remaining() == 0);
  }
}

TEST_CASE("a big-endian writer puts the most significant byte first") {
  ByteWriter writer(std::endian::big);
  writer.u32(0x01020304);
  CHECK(writer.data() == bytesOf({1, 2, 3, 4}));
}

}  // namespace
}  // namespace eye
