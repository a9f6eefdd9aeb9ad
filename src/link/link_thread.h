// The thread named "link": takes datagrams from a socket and hands them to a protocol.
#pragma once

#include <span>
#include <string>
#include <thread>

#include "link/datagram_batch.h"
#include "link/datagram_shape.h"
#include "link/flood_gate.h"
#include "link/flood_gauge.h"
#include "link/host_state.h"
#include "link/udp_socket.h"

namespace eye {

// What is to be sent.
struct Outgoing {
  Peer receiver;
  std::vector<std::byte> datagram;
};

// What a protocol makes of datagrams. Runs on the link thread.
class LinkProtocol {
 public:
  virtual ~LinkProtocol() = default;
  // An error: the datagram was not believed. `nowNs`: when it was taken from the socket.
  virtual Result<void> take(std::span<const std::byte> datagram, const Peer& sender, int64_t nowNs) = 0;
  // After some datagrams, and at least fifty times a second: puts what there is into the mailbox.
  virtual void publish(const HostCounts& counts, int64_t nowNs) = 0;
  // Whom alone it believes now and for a while yet, however little of him comes: the datagrams of others need not be
  // read.
  virtual std::optional<Peer> soleSender(int64_t) const { return std::nullopt; }
  // What a datagram looks like at the least: one that has none of the shapes is never believed. Nothing: any may be.
  // Always the same.
  virtual std::span<const DatagramShape> shapes() const { return {}; }
  // What is to be sent now, of a protocol that asks for its packets. As often as publish().
  virtual std::optional<Outgoing> due(int64_t) { return std::nullopt; }
};

// Owns the thread from construction to stop() or destruction, which take at most some 20 ms. Socket and protocol must
// live longer.
class LinkThread {
 public:
  // `name`: of the link in log messages, such as its URL.
  LinkThread(const UdpSocket& socket, LinkProtocol& protocol, std::string name);
  // Afterwards the thread has ended, and nothing more is sent or taken.
  void stop();

 private:
  void run(const std::stop_token& stop);
  size_t drain();
  void gather(size_t taken, int64_t nowNs);
  void reject(const Error& reason, int64_t nowNs);

  // All of these belong to the link thread once it runs.
  const UdpSocket& socket_;
  LinkProtocol& protocol_;
  std::string name_;
  DatagramBatch batch_;
  HostCounts counts_;
  FloodGauge flood_;
  FloodGate gate_;
  int64_t gatheredNs_ = 0;  // when the batch of a flood was due, or what came instead of one
  int64_t nextComplaintNs_ = 0;
  std::jthread thread_;  // last: it must not start before the rest is there, and joins first
};

}  // namespace eye
