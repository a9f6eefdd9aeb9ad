// Packets, captures and random damage for the link's tests; written by hand, byte by byte, beside the code under test.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <random>
#include <span>
#include <string>
#include <vector>

namespace eye::test {

using Bytes = std::vector<std::byte>;

inline void putU(Bytes& bytes, size_t at, uint64_t value, size_t count, bool bigEndian = true) {
  for (size_t i = 0; i < count; ++i) {
    const size_t shift = 8 * (bigEndian ? count - 1 - i : i);
    bytes.at(at + i) = static_cast<std::byte>(value >> shift & 0xff);
  }
}
inline void putF64(Bytes& bytes, size_t at, double value) {
  uint64_t bits;
  std::memcpy(&bits, &value, 8);
  putU(bytes, at, bits, 8);
}
inline void putF32(Bytes& bytes, size_t at, float value) {
  uint32_t bits;
  std::memcpy(&bits, &value, 4);
  putU(bytes, at, bits, 4);
}

// A version 24 packet, offsets as in FlightGear's net_fdm.hxx.
inline Bytes fdmPacket(double latRad, double lonRad, double altM, float phi, float theta, float psi,
                       float visibilityM) {
  Bytes bytes(408);
  putU(bytes, 0, 24, 4);
  putF64(bytes, 8, lonRad);
  putF64(bytes, 16, latRad);
  putF64(bytes, 24, altM);
  putF32(bytes, 36, phi);
  putF32(bytes, 40, theta);
  putF32(bytes, 44, psi);
  putF32(bytes, 364, visibilityM);
  return bytes;
}

// Byte by byte: on insert() of a range g++ 12 warns of an overflow that there is not.
inline void append(Bytes& to, const Bytes& more) {
  for (const std::byte b : more) to.push_back(b);
}

// An IPv4 UDP packet from 10.0.0.1:1000 to 127.0.0.1:`port`.
inline Bytes ipPacket(const Bytes& payload, uint16_t port) {
  Bytes bytes(28);
  putU(bytes, 0, 0x45, 1);
  putU(bytes, 2, 28 + payload.size(), 2);
  putU(bytes, 8, 64, 1);
  putU(bytes, 9, 17, 1);
  putU(bytes, 12, 0x0a000001, 4);
  putU(bytes, 16, 0x7f000001, 4);
  putU(bytes, 20, 1000, 2);
  putU(bytes, 22, port, 2);
  putU(bytes, 24, 8 + payload.size(), 2);
  append(bytes, payload);
  return bytes;
}

struct PcapWriter {
  bool bigEndian = false, nanoseconds = true;
  Bytes bytes;

  explicit PcapWriter(uint32_t linkType, bool big = false, bool ns = true)
      : bigEndian(big), nanoseconds(ns), bytes(24) {
    putU(bytes, 0, ns ? 0xa1b23c4d : 0xa1b2c3d4, 4, big);
    putU(bytes, 4, 2, 2, big);
    putU(bytes, 6, 4, 2, big);
    putU(bytes, 16, 65535, 4, big);
    putU(bytes, 20, linkType, 4, big);
  }
  void add(int64_t timeNs, const Bytes& frame) {
    Bytes header(16);
    const int64_t fraction = timeNs % 1'000'000'000 / (nanoseconds ? 1 : 1000);
    putU(header, 0, static_cast<uint64_t>(timeNs / 1'000'000'000), 4, bigEndian);
    putU(header, 4, static_cast<uint64_t>(fraction), 4, bigEndian);
    putU(header, 8, frame.size(), 4, bigEndian);
    putU(header, 12, frame.size(), 4, bigEndian);
    append(bytes, header);
    append(bytes, frame);
  }
};

// One to eight random bytes changed, and now and then the end cut off or bytes put in.
template <class Container>
void damage(Container& bytes, std::mt19937_64& random) {
  using Byte = typename Container::value_type;
  const auto place = [&] { return static_cast<size_t>(random() % (bytes.size() + 1)); };
  const uint64_t kind = random() % 8;
  if (kind == 0) bytes.resize(place());
  if (kind == 1)
    bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(place()), 1 + random() % 16, Byte(random() & 0xff));
  for (uint64_t i = 0, count = 1 + random() % 8; i < count && !bytes.empty(); ++i)
    bytes[random() % bytes.size()] = static_cast<Byte>(random() & 0xff);
}

}  // namespace eye::test
