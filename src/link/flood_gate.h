// Closes a link's socket to what comes in floods and is not believed. Owner thread: link.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "link/datagram_shape.h"
#include "link/flood_gauge.h"
#include "link/udp_socket.h"

namespace eye {

// Against strangers: all but the one sender who is heard now; not longer than that speaks. Against garbage: what has
// none of the protocol's shapes, whoever sends it. The first datagrams of a flood are read and refused; those behind
// them the system drops, and not longer than the flood lasts.
class FloodGate {
 public:
  // The socket must live longer. `shapes`: see LinkProtocol; `name`: of the link in log messages.
  FloodGate(const UdpSocket& socket, std::span<const DatagramShape> shapes, std::string name)
      : socket_(socket), shapes_(shapes), name_(std::move(name)) {}

  // A datagram was read for nothing: a stranger's while another speaks, or anybody's.
  void refusedStranger(const Peer& sender) { strangers_.refused(sender); }
  void refused(std::span<const std::byte> datagram, const Peer& sender);
  // Closes or opens, at least fifty times a second. `sole`: see LinkProtocol::soleSender; nothing: anyone may speak.
  void update(const std::optional<Peer>& sole, int64_t nowNs);
  // Datagrams that the system has dropped so far: not admitted, or for want of room.
  uint64_t unread() const { return unread_; }

 private:
  struct Flood {
    FloodGauge gauge{200'000'000};  // a burst that is none is refused one by one, with its reasons
    int64_t count = 0;              // of those refused since the last update
    Peer sender{};                  // the newest
    void refused(const Peer& by) { ++count, sender = by; }
    void update(int64_t unread, int64_t nowNs);
  };
  struct Admitted {
    std::optional<Peer> sender;  // alone
    bool onlyShaped = false;
    bool operator==(const Admitted&) const = default;
  };
  void tell() const;

  const UdpSocket& socket_;
  const std::span<const DatagramShape> shapes_;
  const std::string name_;
  Flood strangers_, garbage_;
  Admitted admitted_;
  uint64_t unread_ = 0;
  uint32_t dropped_ = 0;  // as the socket said last
  int64_t nextNoticeNs_ = 0;
};

}  // namespace eye
