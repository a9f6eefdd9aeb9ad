// What the system drops before a socket's reader sees it: a datagram that is dropped costs no copy, no room in the
// socket's buffer and no waking up.
#pragma once

#include <cstdint>

#include "link/udp_socket.h"

namespace eye {

// From now on datagrams of the one sender alone reach the socket; what is in its buffer already stays there. False
// where the system does not filter: everything reaches it as before.
bool admitOnly(int fd, const Peer& sender);
void admitEveryone(int fd);

// Datagrams that came for the socket and were dropped since it was made, modulo 2^32: those that were not admitted, and
// those for which there was no room.
uint32_t droppedOf(int fd);

}  // namespace eye
