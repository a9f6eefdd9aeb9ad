// An IPv4 UDP socket: bound to receive, or one that sends to a place. Move-only; closes itself.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "link/endpoint.h"

struct mmsghdr;

namespace eye {

struct DatagramShape;

// The largest payload that a UDP datagram over IPv4 can have.
inline constexpr size_t kMaxDatagramBytes = 65507;

// Who sends or receives: an IPv4 address and a port, both in the machine's byte order.
struct Peer {
  uint32_t address = 0;
  uint16_t port = 0;
  bool operator==(const Peer&) const = default;
};
Result<Peer> resolvePeer(const Endpoint& endpoint);
std::string toText(const Peer& peer);  // "127.0.0.1:8000"

enum class SendOutcome {
  sent,
  refused,  // sent, but the other machine has answered to an earlier datagram that nobody listens (yet)
  failed,
};

class UdpSocket {
 public:
  // Listens on the address; port 0 lets the system choose one (see `port`). A multicast group and a broadcast address
  // any number of sockets may share, and each hears everything. `interfaceAddress` (may be empty): of the one network
  // interface on which a group is heard, or by which it is sent to.
  static Result<UdpSocket> listenOn(const Endpoint& endpoint, const std::string& interfaceAddress = "");
  static Result<UdpSocket> connectTo(const Endpoint& endpoint, const std::string& interfaceAddress = "");

  UdpSocket(UdpSocket&& other) noexcept;
  UdpSocket& operator=(UdpSocket&& other) noexcept;
  ~UdpSocket();

  // Waits at most `timeoutMs` for a datagram; true when one is there.
  bool wait(int timeoutMs) const;
  // The next datagram that has already arrived, or nothing. The span points into `buffer`, which should hold
  // kMaxDatagramBytes: what does not fit is lost.
  std::optional<std::span<const std::byte>> receive(std::span<std::byte> buffer) const;
  std::optional<std::span<const std::byte>> receiveFrom(std::span<std::byte> buffer, Peer& sender) const;
  // Of those that have arrived as many as there are headers; how many. For DatagramBatch, which has the buffers.
  size_t receiveMany(std::span<mmsghdr> headers) const;
  // While a flood comes: see link/udp_filter.h. False where the system does not filter.
  bool admitOnly(const std::optional<Peer>& sender, std::span<const DatagramShape> shapes = {}) const;
  void admitEveryone() const;
  uint32_t dropped() const;  // datagrams that never could be received, modulo 2^32

  SendOutcome send(std::span<const std::byte> payload) const;  // of a socket from connectTo
  // Datagrams of `eachBytes`, at most 64 and kMaxDatagramBytes together, with one call of the system, which makes them
  // out of one: a fourth of the cost, or less. False where the system cannot. Of a socket from connectTo to one place.
  bool sendRun(std::span<const std::byte> payloads, size_t eachBytes) const;
  // Of a listening socket, any thread. Never blocks: false when the network does not take it.
  bool sendTo(std::span<const std::byte> payload, const Peer& receiver) const;
  // sendTo() may go to a broadcast address from now on; the system refuses it else.
  void allowBroadcast() const;
  uint16_t port() const;  // the local one

 private:
  explicit UdpSocket(int fd) : fd_(fd) {}
  int fd_ = -1;
  std::optional<Peer> everybody_;  // whom it sends to, where answers come from other addresses than that
};

}  // namespace eye
