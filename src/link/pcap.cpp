#include "link/pcap.h"

#include <fmt/format.h>

#include <optional>

#include "base/byte_reader.h"

// Sources: draft-ietf-opsawg-pcap for the file, tcpdump.org/linktypes.html for the link layers, RFC 791 and 768.

namespace eye {
namespace {

constexpr uint32_t kMagicMicroseconds = 0xa1b2c3d4, kMagicNanoseconds = 0xa1b23c4d, kMagicPcapng = 0x0a0d0d0a;
constexpr uint16_t kEtherIpv4 = 0x0800, kEtherVlan = 0x8100, kEtherVlanOuter = 0x88a8;
constexpr uint32_t kFamilyInet = 2;
constexpr uint8_t kProtocolUdp = 17;

enum LinkType : uint32_t {
  linkNull = 0,  // BSD loopback: family in the capturing host's byte order
  linkEthernet = 1,
  linkRaw = 101,       // IP at once
  linkLoop = 108,      // OpenBSD loopback: family in network byte order
  linkLinuxSll = 113,  // tcpdump -i any
  linkIpv4 = 228,
  linkLinuxSll2 = 276,
};

struct FileHeader {
  std::endian order = std::endian::little;
  int64_t fractionNs = 1000;  // what one unit of a record's second time field is
  uint32_t linkType = 0;
};

Result<FileHeader> readHeader(ByteReader& reader) {
  FileHeader header;
  const uint32_t magic = reader.u32();
  const bool swapped = magic == __builtin_bswap32(kMagicMicroseconds) || magic == __builtin_bswap32(kMagicNanoseconds);
  if (swapped) {
    header.order = std::endian::big;
    reader.setOrder(std::endian::big);
  }
  const uint32_t plain = swapped ? __builtin_bswap32(magic) : magic;
  if (plain == kMagicPcapng)
    return fail(ErrorKind::unsupported, "this is a pcapng capture; convert it with: editcap -F pcap IN OUT");
  if (plain != kMagicMicroseconds && plain != kMagicNanoseconds)
    return fail(ErrorKind::badData, "this is no pcap capture: the file does not begin with its magic number");
  if (plain == kMagicNanoseconds) header.fractionNs = 1;

  reader.skip(16);  // version, time zone, accuracy, snapshot length: none of them changes how records are read
  header.linkType = reader.u32() & 0x0fffffffu;  // the upper bits say how long a frame check sequence is
  if (!reader.ok()) return fail(ErrorKind::badData, "the pcap capture ends inside its header");
  switch (header.linkType) {
    case linkNull:
    case linkEthernet:
    case linkRaw:
    case linkLoop:
    case linkLinuxSll:
    case linkIpv4:
    case linkLinuxSll2:
      return header;
    default:
      return fail(
          ErrorKind::unsupported,
          fmt::format("the pcap capture has link type {}; Ethernet, raw IP, BSD loopback and Linux cooked are read",
                      header.linkType));
  }
}

// The IP packet inside a frame, or nothing when the frame holds something else.
std::optional<std::span<const std::byte>> ipv4Packet(std::span<const std::byte> frame, const FileHeader& header) {
  ByteReader reader(frame, std::endian::big);
  uint16_t etherType = kEtherIpv4;
  switch (header.linkType) {
    case linkNull:
      reader.setOrder(header.order);
      if (reader.u32() != kFamilyInet) return std::nullopt;
      break;
    case linkLoop:
      if (reader.u32() != kFamilyInet) return std::nullopt;
      break;
    case linkEthernet:
      reader.skip(12);  // destination, source
      etherType = reader.u16();
      for (int tag = 0; tag < 2 && (etherType == kEtherVlan || etherType == kEtherVlanOuter); ++tag) {
        reader.skip(2);
        etherType = reader.u16();
      }
      break;
    case linkLinuxSll:
      reader.skip(14);
      etherType = reader.u16();
      break;
    case linkLinuxSll2:
      etherType = reader.u16();
      reader.skip(18);
      break;
    default:
      break;
  }
  if (!reader.ok() || etherType != kEtherIpv4) return std::nullopt;
  return frame.subspan(reader.position());
}

std::optional<CapturedDatagram> udpDatagram(std::span<const std::byte> packet) {
  ByteReader ip(packet, std::endian::big);
  const uint8_t versionAndLength = ip.u8();
  const size_t headerBytes = size_t{versionAndLength & 0x0fu} * 4;
  ip.skip(5);  // service, total length (offloading leaves it 0), identification
  const uint16_t fragment = ip.u16();
  ip.skip(1);  // time to live
  const uint8_t protocol = ip.u8();
  ip.skip(6);  // checksum (offloading leaves it wrong), source
  CapturedDatagram datagram;
  datagram.destination = ip.u32();
  const bool isFragment = (fragment & 0x3fffu) != 0;  // "more fragments", or an offset
  if (!ip.ok() || versionAndLength >> 4 != 4 || headerBytes < 20 || protocol != kProtocolUdp || isFragment)
    return std::nullopt;
  ip.skip(headerBytes - 20);  // options

  ip.skip(2);  // source port
  datagram.destinationPort = ip.u16();
  const uint16_t udpBytes = ip.u16();
  ip.skip(2);  // checksum
  if (!ip.ok() || udpBytes < 8) return std::nullopt;
  datagram.payload = ip.bytes(udpBytes - 8u);
  if (!ip.ok()) return std::nullopt;  // cut by the snapshot length
  return datagram;
}

}  // namespace

Result<Capture> parsePcap(std::span<const std::byte> file) {
  ByteReader reader(file, std::endian::little);
  const auto header = readHeader(reader);
  if (!header) return tl::unexpected(header.error());

  Capture capture;
  for (size_t records = 0; reader.remaining() > 0; ++records) {
    if (records == kMaxCapturedRecords)
      return fail(ErrorKind::badData,
                  fmt::format("the pcap capture has more than {} records; cut it with editcap", kMaxCapturedRecords));
    const int64_t seconds = reader.u32();
    const int64_t fraction = reader.u32();
    const uint32_t capturedBytes = reader.u32();
    reader.skip(4);  // length on the wire: a datagram that was cut shows in its own lengths
    const auto frame = reader.bytes(capturedBytes);
    if (!reader.ok()) {
      capture.truncated = true;
      break;
    }
    const auto packet = ipv4Packet(frame, *header);
    auto datagram = packet ? udpDatagram(*packet) : std::nullopt;
    if (!datagram) {
      ++capture.passedOver;
      continue;
    }
    datagram->timeNs = seconds * 1'000'000'000 + fraction * header->fractionNs;
    capture.datagrams.push_back(*datagram);
  }
  return capture;
}

}  // namespace eye
