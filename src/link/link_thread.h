// The thread named "link": takes datagrams from a socket, has them parsed and puts the newest state into a mailbox.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <thread>

#include "link/host_state.h"
#include "link/udp_socket.h"

namespace eye {

// What a protocol makes of one datagram; `arrivedNs` of the state is set by the link thread. Runs on the link thread.
using DatagramParser = std::function<Result<HostState>(std::span<const std::byte>)>;

// Owns socket and thread from construction to destruction, which takes at most some 20 ms. The mailbox must live
// longer.
class LinkThread {
 public:
  // `name`: of the link in log messages, such as its URL.
  LinkThread(UdpSocket socket, DatagramParser parser, Mailbox& mailbox, std::string name);

 private:
  void run(const std::stop_token& stop);
  void drain();
  void reject(const Error& reason, int64_t nowNs);

  // All of these belong to the link thread once it runs.
  UdpSocket socket_;
  DatagramParser parser_;
  Mailbox& mailbox_;
  std::string name_;
  std::vector<std::byte> buffer_;
  HostCounts counts_;
  int64_t nextComplaintNs_ = 0;
  std::jthread thread_;  // last: it must not start before the rest is there, and joins first
};

}  // namespace eye
