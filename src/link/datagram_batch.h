// Datagrams that have arrived, many with one call of the system: a flood costs a third of what it does one by one.
#pragma once

#include <sys/socket.h>

#include <netinet/in.h>
#include <array>
#include <cstddef>
#include <memory>
#include <span>

#include "link/udp_socket.h"

namespace eye {

struct Datagram {
  std::span<const std::byte> payload;
  Peer sender;
};

inline constexpr size_t kBatchDatagrams = 64;

// Not movable: the system's lists point into it. Owner thread: the receiver's.
class DatagramBatch {
 public:
  DatagramBatch();
  DatagramBatch(const DatagramBatch&) = delete;
  DatagramBatch& operator=(const DatagramBatch&) = delete;
  // Those that are there, at most kBatchDatagrams; valid until the next call. Never waits.
  std::span<const Datagram> receive(const UdpSocket& socket);

 private:
  std::unique_ptr<std::byte[]> bytes_;  // 4 MiB that only large datagrams make the system give
  std::array<sockaddr_in, kBatchDatagrams> senders_{};
  std::array<iovec, kBatchDatagrams> places_{};
  std::array<mmsghdr, kBatchDatagrams> headers_{};
  std::array<Datagram, kBatchDatagrams> datagrams_{};
};

}  // namespace eye
