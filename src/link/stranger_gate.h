// Closes a link's socket to strangers while they send floods and cannot be heard. Owner thread: link.
#pragma once

#include <optional>
#include <string>

#include "link/flood_gauge.h"
#include "link/udp_socket.h"

namespace eye {

// Strangers: all but the one sender who is heard now. The first datagrams of a flood are read and refused; those behind
// them the system drops, and not longer than the flood lasts and the sender speaks.
class StrangerGate {
 public:
  // The socket must live longer. `name`: of the link in log messages.
  StrangerGate(const UdpSocket& socket, std::string name) : socket_(socket), name_(std::move(name)) {}

  // A stranger's datagram was read for nothing.
  void refused(const Peer& stranger);
  // Closes or opens, at least fifty times a second. `sole`: see LinkProtocol::soleSender; nothing: anyone may speak.
  void update(const std::optional<Peer>& sole, int64_t nowNs);
  // Datagrams that the system has dropped so far: of strangers, or for want of room.
  uint64_t unread() const { return unread_; }

 private:
  const UdpSocket& socket_;
  const std::string name_;
  FloodGauge flood_{200'000'000};  // a burst that is none is refused one by one, with its reasons
  int64_t refused_ = 0;            // since the last update
  Peer stranger_;                  // the newest
  std::optional<Peer> admitted_;
  uint64_t unread_ = 0;
  uint32_t dropped_ = 0;  // as the socket said last
  int64_t nextNoticeNs_ = 0;
};

}  // namespace eye
