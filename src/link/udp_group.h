// Addresses that many sockets hear at once, multicast groups and broadcast, and what a socket needs for them.
#pragma once

#include <cstdint>
#include <optional>

#include "base/error.h"

namespace eye {

enum class Reach { one, multicast, broadcast };

// Broadcast: 255.255.255.255, loopback's 127.255.255.255, or that of one of the machine's networks. The address is in
// the machine's byte order, as all of them here.
Reach reachOf(uint32_t address);

// A listening socket hears the group on the network interface that has the address, or without one on all of them,
// loopback too; and no other socket's group.
Result<void> joinGroup(int fd, uint32_t group, std::optional<uint32_t> interfaceAddress);

// A sending socket sends to groups by the interface that has the address instead of the one that routing chooses.
Result<void> sendGroupsBy(int fd, uint32_t interfaceAddress);

}  // namespace eye
