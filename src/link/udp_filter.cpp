#include "link/udp_filter.h"

#include <linux/filter.h>
#include <linux/sock_diag.h>
#include <sys/socket.h>

#include <array>

namespace eye {
namespace {

constexpr uint32_t kWholeDatagram = 0xffffffff, kNothing = 0;
constexpr uint32_t kSourcePortOffset = 0;      // in the UDP header (RFC 768), at which the system begins counting
constexpr uint32_t kSourceAddressOffset = 12;  // in the IPv4 header (RFC 791)

constexpr sock_filter load(uint16_t size, uint32_t offset) {
  return {static_cast<uint16_t>(BPF_LD | size | BPF_ABS), 0, 0, offset};
}
// Goes on behind the next ones where the value that was loaded is another.
constexpr sock_filter elseSkip(uint32_t expected, uint8_t instructions) {
  return {BPF_JMP | BPF_JEQ | BPF_K, 0, instructions, expected};
}
constexpr sock_filter take(uint32_t bytes) {
  return {BPF_RET | BPF_K, 0, 0, bytes};
}

}  // namespace

bool admitOnly(int fd, const Peer& sender) {
  // Loaded values are in the machine's byte order, as a peer's are.
  std::array program{load(BPF_H, kSourcePortOffset),
                     elseSkip(sender.port, 3),
                     load(BPF_W, static_cast<uint32_t>(SKF_NET_OFF) + kSourceAddressOffset),
                     elseSkip(sender.address, 1),
                     take(kWholeDatagram),
                     take(kNothing)};
  const sock_fprog filter{static_cast<uint16_t>(program.size()), program.data()};
  return setsockopt(fd, SOL_SOCKET, SO_ATTACH_FILTER, &filter, sizeof(filter)) == 0;
}

void admitEveryone(int fd) {
  const int unused = 0;
  setsockopt(fd, SOL_SOCKET, SO_DETACH_FILTER, &unused, sizeof(unused));
}

uint32_t droppedOf(int fd) {
  std::array<uint32_t, SK_MEMINFO_VARS> counts{};
  socklen_t bytes = sizeof(counts);
  return getsockopt(fd, SOL_SOCKET, SO_MEMINFO, counts.data(), &bytes) == 0 ? counts[SK_MEMINFO_DROPS] : 0;
}

}  // namespace eye
