// What the system drops before a socket's reader sees it: a datagram that is dropped costs no copy, no room in the
// socket's buffer and no waking up.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "link/datagram_shape.h"
#include "link/udp_socket.h"

namespace eye {

// From now on datagrams of the one sender alone reach the socket, where one is given, and those alone that have one of
// the shapes, where there are some; what is in its buffer already stays there. False where the system does not filter:
// everything reaches it as before.
bool admitOnly(int fd, const std::optional<Peer>& sender, std::span<const DatagramShape> shapes);
void admitEveryone(int fd);

// Datagrams that came for the socket and were dropped since it was made, modulo 2^32: those that were not admitted, and
// those for which there was no room.
uint32_t droppedOf(int fd);

}  // namespace eye
