#include "link/udp_socket.h"

#include <fmt/format.h>
#include <netdb.h>
#include <netinet/udp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "link/udp_filter.h"
#include "link/udp_group.h"

namespace eye {
namespace {

Result<sockaddr_in> resolve(const Endpoint& endpoint) {
  addrinfo hints{};
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  const int problem = getaddrinfo(endpoint.address.c_str(), nullptr, &hints, &found);
  if (problem != 0 || found == nullptr)
    return fail(ErrorKind::usage, fmt::format("'{}' is no IPv4 address or known host ({})", endpoint.address,
                                              problem != 0 ? gai_strerror(problem) : "no answer"));
  sockaddr_in address{};
  std::memcpy(&address, found->ai_addr, sizeof(address));
  freeaddrinfo(found);
  address.sin_port = htons(endpoint.port);
  return address;
}

Result<int> newSocket() {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (fd < 0) return fail(ErrorKind::io, fmt::format("cannot make a UDP socket: {}", std::strerror(errno)));
  return fd;
}

sockaddr_in addressOf(const Peer& peer) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(peer.address);
  address.sin_port = htons(peer.port);
  return address;
}

// The interface's address, where one is named.
Result<std::optional<uint32_t>> groupInterface(Reach reach, const std::string& interfaceAddress) {
  if (interfaceAddress.empty()) return std::nullopt;
  if (reach != Reach::multicast)
    return fail(ErrorKind::usage, fmt::format("a network interface ({}) can be chosen for a multicast group, 224.0.0.0 "
                                              "to 239.255.255.255, alone",
                                              interfaceAddress));
  const auto interface = resolvePeer({interfaceAddress, 0});
  if (!interface) return tl::unexpected(interface.error());
  return interface->address;
}

const sockaddr* asSockaddr(const sockaddr_in& address) {
  return reinterpret_cast<const sockaddr*>(&address);
}

}  // namespace

Result<Peer> resolvePeer(const Endpoint& endpoint) {
  const auto address = resolve(endpoint);
  if (!address) return tl::unexpected(address.error());
  return Peer{ntohl(address->sin_addr.s_addr), endpoint.port};
}

std::string toText(const Peer& peer) {
  return fmt::format("{}.{}.{}.{}:{}", peer.address >> 24, peer.address >> 16 & 0xff, peer.address >> 8 & 0xff,
                     peer.address & 0xff, peer.port);
}

Result<UdpSocket> UdpSocket::listenOn(const Endpoint& endpoint, const std::string& interfaceAddress) {
  const auto address = resolve(endpoint);
  if (!address) return tl::unexpected(address.error());
  const auto fd = newSocket();
  if (!fd) return tl::unexpected(fd.error());
  UdpSocket udp(*fd);

  const uint32_t listened = ntohl(address->sin_addr.s_addr);
  const Reach reach = reachOf(listened);
  const auto interface = groupInterface(reach, interfaceAddress);
  if (!interface) return tl::unexpected(interface.error());
  if (reach != Reach::one) {
    const int shared = 1;
    setsockopt(*fd, SOL_SOCKET, SO_REUSEADDR, &shared, sizeof(shared));
  }
  if (reach == Reach::multicast)
    if (const auto joined = joinGroup(*fd, listened, *interface); !joined) return tl::unexpected(joined.error());

  // Room for what comes while the reader does not run, where the system grants so much; and no more than that, because
  // of a flood it is full, and what is read is as old as it is deep. The system gives twice what is asked for and
  // counts 768 bytes for a small datagram, 1,280 for native-fdm's: 1,365 and 819 of them, 43 and 26 ms of the most that
  // is read.
  const int receiveBytes = 512 << 10;
  setsockopt(*fd, SOL_SOCKET, SO_RCVBUF, &receiveBytes, sizeof(receiveBytes));
  if (bind(*fd, asSockaddr(*address), sizeof(*address)) == 0) return udp;

  const int problem = errno;
  const std::string place = fmt::format("{}:{}", endpoint.address, endpoint.port);
  if (problem == EADDRINUSE)
    return fail(ErrorKind::io, fmt::format("UDP port {} is taken by another program; stop it (ss -ulnp shows which) "
                                           "or choose another port",
                                           place));
  if (problem == EADDRNOTAVAIL)
    return fail(ErrorKind::io, fmt::format("cannot listen on {}: this machine has no such address; use 0.0.0.0 for all "
                                           "of its addresses",
                                           place));
  if (problem == EACCES)
    return fail(ErrorKind::io, fmt::format("cannot listen on UDP {}: not allowed; use a port above 1023", place));
  return fail(ErrorKind::io, fmt::format("cannot listen on UDP {}: {}", place, std::strerror(problem)));
}

Result<UdpSocket> UdpSocket::connectTo(const Endpoint& endpoint, const std::string& interfaceAddress) {
  const auto address = resolve(endpoint);
  if (!address) return tl::unexpected(address.error());
  const auto fd = newSocket();
  if (!fd) return tl::unexpected(fd.error());
  UdpSocket udp(*fd);

  const Peer receiver{ntohl(address->sin_addr.s_addr), endpoint.port};
  const Reach reach = reachOf(receiver.address);
  const auto interface = groupInterface(reach, interfaceAddress);
  if (!interface) return tl::unexpected(interface.error());
  if (*interface)
    if (const auto chosen = sendGroupsBy(*fd, **interface); !chosen) return tl::unexpected(chosen.error());
  if (reach != Reach::one) {
    // A connected socket would hear nobody: who answers has an address of its own.
    udp.allowBroadcast();
    udp.everybody_ = receiver;
    return udp;
  }
  if (connect(*fd, asSockaddr(*address), sizeof(*address)) == 0) return udp;
  return fail(ErrorKind::io,
              fmt::format("cannot send UDP to {}:{}: {}", endpoint.address, endpoint.port, std::strerror(errno)));
}

UdpSocket::UdpSocket(UdpSocket&& other) noexcept : fd_(std::exchange(other.fd_, -1)), everybody_(other.everybody_) {}

UdpSocket& UdpSocket::operator=(UdpSocket&& other) noexcept {
  std::swap(fd_, other.fd_);
  std::swap(everybody_, other.everybody_);
  return *this;
}

UdpSocket::~UdpSocket() {
  if (fd_ >= 0) close(fd_);
}

bool UdpSocket::wait(int timeoutMs) const {
  pollfd events{fd_, POLLIN, 0};
  return poll(&events, 1, timeoutMs) > 0;
}

std::optional<std::span<const std::byte>> UdpSocket::receive(std::span<std::byte> buffer) const {
  const ssize_t bytes = recv(fd_, buffer.data(), buffer.size(), 0);
  if (bytes < 0) return std::nullopt;
  return buffer.first(static_cast<size_t>(bytes));
}

std::optional<std::span<const std::byte>> UdpSocket::receiveFrom(std::span<std::byte> buffer, Peer& sender) const {
  sockaddr_in address{};
  socklen_t length = sizeof(address);
  const ssize_t bytes = recvfrom(fd_, buffer.data(), buffer.size(), 0, reinterpret_cast<sockaddr*>(&address), &length);
  if (bytes < 0) return std::nullopt;
  sender = {ntohl(address.sin_addr.s_addr), ntohs(address.sin_port)};
  return buffer.first(static_cast<size_t>(bytes));
}

size_t UdpSocket::receiveMany(std::span<mmsghdr> headers) const {
  const int count = recvmmsg(fd_, headers.data(), static_cast<unsigned>(headers.size()), MSG_DONTWAIT, nullptr);
  return count < 0 ? 0 : static_cast<size_t>(count);
}

bool UdpSocket::admitOnly(const std::optional<Peer>& sender, std::span<const DatagramShape> shapes) const {
  return eye::admitOnly(fd_, sender, shapes);
}

void UdpSocket::admitEveryone() const {
  eye::admitEveryone(fd_);
}

uint32_t UdpSocket::dropped() const {
  return droppedOf(fd_);
}

bool UdpSocket::sendTo(std::span<const std::byte> payload, const Peer& receiver) const {
  const sockaddr_in address = addressOf(receiver);
  return sendto(fd_, payload.data(), payload.size(), MSG_NOSIGNAL | MSG_DONTWAIT, asSockaddr(address),
                sizeof(address)) == static_cast<ssize_t>(payload.size());
}

SendOutcome UdpSocket::send(std::span<const std::byte> payload) const {
  if (everybody_) return sendTo(payload, *everybody_) ? SendOutcome::sent : SendOutcome::failed;
  const auto once = [&] { return ::send(fd_, payload.data(), payload.size(), MSG_NOSIGNAL); };
  const auto whole = static_cast<ssize_t>(payload.size());
  if (once() == whole) return SendOutcome::sent;
  // The refusal of an earlier datagram is reported instead of sending this one: try it again.
  if (errno == ECONNREFUSED && once() == whole) return SendOutcome::refused;
  return SendOutcome::failed;
}

bool UdpSocket::sendRun(std::span<const std::byte> payloads, size_t eachBytes) const {
  iovec place{const_cast<std::byte*>(payloads.data()), payloads.size()};
  alignas(cmsghdr) std::array<std::byte, CMSG_SPACE(sizeof(uint16_t))> control{};
  msghdr message{};
  message.msg_iov = &place;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  cmsghdr* const header = CMSG_FIRSTHDR(&message);
  header->cmsg_level = SOL_UDP;
  header->cmsg_type = UDP_SEGMENT;
  header->cmsg_len = CMSG_LEN(sizeof(uint16_t));
  const auto each = static_cast<uint16_t>(eachBytes);
  std::memcpy(CMSG_DATA(header), &each, sizeof(each));
  return sendmsg(fd_, &message, MSG_NOSIGNAL) == static_cast<ssize_t>(payloads.size());
}

void UdpSocket::allowBroadcast() const {
  const int allowed = 1;
  setsockopt(fd_, SOL_SOCKET, SO_BROADCAST, &allowed, sizeof(allowed));
}

uint16_t UdpSocket::port() const {
  sockaddr_in address{};
  socklen_t length = sizeof(address);
  if (getsockname(fd_, reinterpret_cast<sockaddr*>(&address), &length) != 0) return 0;
  return ntohs(address.sin_port);
}

}  // namespace eye
