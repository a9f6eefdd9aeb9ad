#include "link/udp_group.h"

#include <fmt/format.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>
#include <vector>

namespace eye {
namespace {

constexpr uint32_t kEverybody = 0xffffffff, kLoopbackBroadcast = 0x7fffffff;

struct Interface {
  uint32_t address = 0;
  std::optional<uint32_t> broadcast;
  bool hearsGroups = false;  // loopback does, though it does not say so
};

uint32_t addressIn(const sockaddr* address) {
  sockaddr_in internet{};
  std::memcpy(&internet, address, sizeof(internet));
  return ntohl(internet.sin_addr.s_addr);
}

// Those that are up and have an IPv4 address.
std::vector<Interface> interfaces() {
  std::vector<Interface> found;
  ifaddrs* all = nullptr;
  if (getifaddrs(&all) != 0) return found;
  for (const ifaddrs* each = all; each != nullptr; each = each->ifa_next) {
    if (each->ifa_addr == nullptr || each->ifa_addr->sa_family != AF_INET || (each->ifa_flags & IFF_UP) == 0) continue;
    Interface interface {
      addressIn(each->ifa_addr), std::nullopt, (each->ifa_flags & (IFF_MULTICAST | IFF_LOOPBACK)) != 0
    };
    if ((each->ifa_flags & IFF_BROADCAST) != 0 && each->ifa_broadaddr != nullptr)
      interface.broadcast = addressIn(each->ifa_broadaddr);
    found.push_back(interface);
  }
  freeifaddrs(all);
  return found;
}

bool join(int fd, uint32_t group, uint32_t interfaceAddress) {
  ip_mreqn membership{};
  membership.imr_multiaddr.s_addr = htonl(group);
  membership.imr_address.s_addr = htonl(interfaceAddress);
  // In use: an interface with two addresses, which is a member already.
  return setsockopt(fd, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof(membership)) == 0 || errno == EADDRINUSE;
}

std::string inDots(uint32_t address) {
  return fmt::format("{}.{}.{}.{}", address >> 24, address >> 16 & 0xff, address >> 8 & 0xff, address & 0xff);
}

tl::unexpected<Error> noSuchInterface(uint32_t address) {
  return fail(ErrorKind::usage, fmt::format("no network interface has the address {} ({}); 'ip -4 address' lists them",
                                            inDots(address), std::strerror(errno)));
}

}  // namespace

Reach reachOf(uint32_t address) {
  if (address >> 28 == 0xe) return Reach::multicast;
  if (address == kEverybody || address == kLoopbackBroadcast) return Reach::broadcast;
  for (const Interface& interface : interfaces())
    if (interface.broadcast == address && interface.address != address) return Reach::broadcast;
  return Reach::one;
}

Result<void> joinGroup(int fd, uint32_t group, std::optional<uint32_t> interfaceAddress) {
  const int othersGroups = 0;
  setsockopt(fd, IPPROTO_IP, IP_MULTICAST_ALL, &othersGroups, sizeof(othersGroups));
  if (interfaceAddress) {
    if (!join(fd, group, *interfaceAddress)) return noSuchInterface(*interfaceAddress);
    return {};
  }
  bool isMember = false;
  for (const Interface& interface : interfaces())
    isMember = (interface.hearsGroups && join(fd, group, interface.address)) || isMember;
  if (isMember) return {};
  return fail(ErrorKind::io, fmt::format("no network interface takes part in the multicast group {}: {}", inDots(group),
                                         std::strerror(errno)));
}

Result<void> sendGroupsBy(int fd, uint32_t interfaceAddress) {
  ip_mreqn by{};
  by.imr_address.s_addr = htonl(interfaceAddress);
  if (setsockopt(fd, IPPROTO_IP, IP_MULTICAST_IF, &by, sizeof(by)) != 0) return noSuchInterface(interfaceAddress);
  return {};
}

}  // namespace eye
