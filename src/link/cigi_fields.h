// How a CIGI packet's fields are reached. A layout (cigi_layout_*.h) lists them once, and runs against a FieldReader,
// which fills the struct, or a FieldWriter, which fills the packet.
#pragma once

#include <bit>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <type_traits>

#include "link/cigi_packets.h"

namespace eye::cigi {

struct Version {
  uint8_t major = 3, minor = 3;
  bool operator==(const Version&) const = default;
};
inline constexpr uint8_t kNewestMinor3 = 3;

// 4.0, or 3.x from this x on.
constexpr bool isSince(Version version, uint8_t minor) {
  return version.major > 3 || version.minor >= minor;
}

// How a message is written.
struct Format {
  Version version;
  std::endian order = std::endian::little;  // CIGI's senders write their own
  bool operator==(const Format&) const = default;
};

// Byte offsets in a packet of 3.x and of 4.0. 0, where every packet has its size or id, means that the field is absent.
struct At {
  uint8_t v3, v4;
  constexpr size_t in(Version version) const { return version.major == 3 ? v3 : v4; }
};
inline constexpr uint8_t kAbsent = 0;

// What a number may be, and its name in complaints.
struct Range {
  const char* name;
  double lowest, highest;
};

class FieldReader {
 public:
  static constexpr bool kReads = true;
  FieldReader(std::span<const std::byte> packet, const Format& format) : packet_(packet), format_(format) {}

  bool bigEndian() const { return format_.order == std::endian::big; }
  bool has(At at) const { return at.in(format_.version) != 0; }
  bool since(uint8_t minor) const { return isSince(format_.version, minor); }
  // Why the packet is not believed; nothing so far where it is.
  const std::optional<std::string>& problem() const { return problem_; }
  void reject(std::string why);
  void require(bool holds, const char* why);

  void u8(At at, uint8_t& value);
  void u8(At at, uint8_t& value, const Range& range);
  void i8(At at, int8_t& value);
  void u16(At at, uint16_t& value);
  void u32(At at, uint32_t& value);
  void f32(At at, double& value, const Range& range);
  void f64(At at, double& value, const Range& range);
  void flag(At at, uint8_t mask, bool& value);
  void bits(At at, uint8_t mask, uint8_t& value);
  // A value of an enumeration up to `last`.
  template <class E>
  void choice(At at, uint8_t mask, E& value, E last, const char* name) {
    uint8_t number = static_cast<uint8_t>(value);
    bits(at, mask, number);
    if (number > static_cast<uint8_t>(last))
      reject(std::string(name) + " " + std::to_string(number) + " means nothing");
    else
      value = static_cast<E>(number);
  }
  // Whether an optional part is there; what is in it, the layout reads where it is.
  template <class T>
  void present(At at, uint8_t mask, std::optional<T>& value) {
    bool isThere = false;
    flag(at, mask, isThere);
    if (isThere) value.emplace();
  }
  // Which frame a point is in, then its three numbers.
  void frame(At at, uint8_t mask, Point& point);
  void point(At at, Point& point, double lowestAltitudeM);
  void date(At at, DateTime& date);  // MMDDYYYY as a decimal number

 private:
  uint64_t load(At at, size_t count);
  void check(double value, const Range& range);

  std::span<const std::byte> packet_;
  Format format_;
  std::optional<std::string> problem_;
};

class FieldWriter {
 public:
  static constexpr bool kReads = false;
  FieldWriter(std::span<std::byte> packet, const Format& format) : packet_(packet), format_(format) {}

  bool bigEndian() const { return format_.order == std::endian::big; }
  bool has(At at) const { return at.in(format_.version) != 0; }
  bool since(uint8_t minor) const { return isSince(format_.version, minor); }
  void require(bool, const char*) {}

  void u8(At at, uint8_t value) { store(at, value, 1); }
  void u8(At at, uint8_t value, const Range&) { store(at, value, 1); }
  void i8(At at, int8_t value) { store(at, static_cast<uint8_t>(value), 1); }
  void u16(At at, uint16_t value) { store(at, value, 2); }
  void u32(At at, uint32_t value) { store(at, value, 4); }
  void f32(At at, double value, const Range&) { store(at, std::bit_cast<uint32_t>(static_cast<float>(value)), 4); }
  void f64(At at, double value, const Range&) { store(at, std::bit_cast<uint64_t>(value), 8); }
  void flag(At at, uint8_t mask, bool value) { bits(at, mask, value ? 1 : 0); }
  void bits(At at, uint8_t mask, uint8_t value);
  template <class E>
  void choice(At at, uint8_t mask, E value, E, const char*) {
    bits(at, mask, static_cast<uint8_t>(value));
  }
  template <class T>
  void present(At at, uint8_t mask, const std::optional<T>& value) {
    flag(at, mask, value.has_value());
  }
  void frame(At at, uint8_t mask, const Point& point) { flag(at, mask, std::holds_alternative<BodyOffset>(point)); }
  void point(At at, const Point& point, double lowestAltitudeM);
  void date(At at, const DateTime& date);

 private:
  void store(At at, uint64_t value, size_t count);

  std::span<std::byte> packet_;
  Format format_;
};

// The struct that a layout goes through: written to by a reader, read by a writer.
template <class Io, class T>
using Of = std::conditional_t<Io::kReads, T, const T>;

}  // namespace eye::cigi
