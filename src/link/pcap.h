// UDP datagrams out of a classic pcap capture (tcpdump -w, Wireshark, editcap -F pcap). Pure and bounded: bytes in,
// datagrams or an error out. What is not a whole IPv4 UDP datagram is passed over and counted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/error.h"

namespace eye {

struct CapturedDatagram {
  int64_t timeNs = 0;        // since 1970, as the capture states it; need not be in order
  uint32_t destination = 0;  // IPv4 address, host byte order
  uint16_t destinationPort = 0;
  std::span<const std::byte> payload;  // points into the bytes that were parsed
};

struct Capture {
  std::vector<CapturedDatagram> datagrams;
  size_t passedOver = 0;   // records that are no complete IPv4 UDP datagram
  bool truncated = false;  // the file ends inside a record, as after a crash; what came before is here
};

inline constexpr size_t kMaxCapturedRecords = 2'000'000;  // 9 hours of 60 Hz; a record is at least 16 bytes of file

Result<Capture> parsePcap(std::span<const std::byte> file);

}  // namespace eye
