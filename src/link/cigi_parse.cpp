#include <fmt/format.h>

#include <algorithm>

#include "base/byte_reader.h"
#include "link/cigi.h"
#include "link/cigi_layout_environment.h"
#include "link/cigi_layout_host.h"
#include "link/cigi_layout_ig.h"
#include "link/cigi_shapes.h"
#include "link/udp_socket.h"

namespace eye::cigi {
namespace {

constexpr size_t kMinPacketBytes = 8;  // all packets are multiples of this; ids and sizes fit well within

// IG Control's first eight bytes. 3.x: id, size, version; a minor version of at most 3 above; the byte order mark.
constexpr uint32_t kHeader3 = kShape<IgControl>.id3 << 24 | 3 << 8, kHeader3Mask = 0xff00ff00;
constexpr WordRange kSize3{0, 0x00ff0000, kOldHeaderBytes << 16, 0x00ff0000};
constexpr WordRange kBig3[] = {wordIs(0, kHeader3Mask, kHeader3), kSize3, wordIs(4, 0xc000ffff, 0x8000)};
constexpr WordRange kLittle3[] = {wordIs(0, kHeader3Mask, kHeader3), kSize3, wordIs(4, 0xc000ffff, 0x0080)};
static_assert(kNewestMinor3 == 0x3f >> 4);
// 4.x: size and id, in the sender's order; version.
constexpr WordRange kVersion4 = wordIs(4, 0xff000000, 4 << 24);
constexpr WordRange kBig4[] = {wordIs(0, 0xffffffff, kShape<IgControl>.bytes4 << 16), kVersion4};
constexpr WordRange kLittle4[] = {wordIs(0, 0xffffffff, kShape<IgControl>.bytes4 << 24), kVersion4};
static_assert(kShape<IgControl>.id4 == 0);
constexpr DatagramShape kHostShapes[] = {{kOldHeaderBytes, kMaxDatagramBytes, kBig3},
                                         {kOldHeaderBytes, kMaxDatagramBytes, kLittle3},
                                         {kShape<IgControl>.bytes4, kMaxDatagramBytes, kBig4},
                                         {kShape<IgControl>.bytes4, kMaxDatagramBytes, kLittle4}};

uint8_t byteAt(std::span<const std::byte> bytes, size_t at) {
  return std::to_integer<uint8_t>(bytes[at]);
}

tl::unexpected<Error> noCigi(const std::string& why) {
  return fail(ErrorKind::badData, "this is no CIGI message: " + why);
}

tl::unexpected<Error> unsupportedVersion(const std::string& version) {
  return fail(
      ErrorKind::unsupported,
      fmt::format("the message is CIGI {}; 3.0 to 3.3 and 4.0 are understood: set the host to one of them", version));
}

// 3.x: id and size are bytes, byte 2 is the version, and bytes 6 and 7 are 0x8000 in the sender's order.
Result<Format> formatOf3(std::span<const std::byte> datagram) {
  const uint8_t id = byteAt(datagram, 0), version = byteAt(datagram, 2);
  if (id != kShape<IgControl>.id3 && id != kShape<StartOfFrame>.id3)
    return noCigi(fmt::format("it begins with packet {}, not with IG Control or Start of Frame", id));
  if (version == 1 || version == 2) return unsupportedVersion(std::to_string(version));
  if (version != 3) return noCigi(fmt::format("its version would be {}", version));

  Format format;
  const uint16_t order = ByteReader(datagram.subspan(6), std::endian::big).u16();
  if (order == 0x8000)
    format.order = std::endian::big;
  else if (order == 0x0080)
    format.order = std::endian::little;
  else
    return noCigi(fmt::format("its byte order mark is 0x{:04x}, neither 0x8000 nor 0x0080", order));
  const uint8_t minor = byteAt(datagram, id == kShape<IgControl>.id3 ? 4 : 5) >> 4;
  if (minor > kNewestMinor3) return unsupportedVersion(fmt::format("3.{}", minor));
  format.version = {3, minor};
  return format;
}

// 4.x: size and id are words; the size of a header is less than 256, so its high byte tells the order.
Result<Format> formatOf4(std::span<const std::byte> datagram) {
  Format format;
  format.order = byteAt(datagram, 0) == 0 ? std::endian::big : std::endian::little;
  ByteReader reader(datagram, format.order);
  const uint16_t size = reader.u16(), id = reader.u16();
  const uint8_t version = reader.u8();
  if (id != kShape<IgControl>.id4 && id != kShape<StartOfFrame>.id4)
    return noCigi(fmt::format("it begins with packet 0x{:04x}, not with IG Control or Start of Frame", id));
  if (size != kShape<IgControl>.bytes4) return noCigi(fmt::format("its header would have {} bytes", size));
  if (version != 4) return unsupportedVersion(std::to_string(version));
  format.version = {4, static_cast<uint8_t>(byteAt(datagram, 7) >> 4)};
  return format;
}

Result<Format> formatOf(std::span<const std::byte> datagram) {
  if (datagram.size() < kOldHeaderBytes) return noCigi(fmt::format("it has {} bytes", datagram.size()));
  // Byte 2 is the version in 3.x, and one half of the header's id in 4.0.
  const uint8_t versionOrId = byteAt(datagram, 2);
  return versionOrId == 0x00 || versionOrId == 0xff ? formatOf4(datagram) : formatOf3(datagram);
}

struct Frame {  // of one packet
  uint16_t id = 0;
  size_t bytes = 0;
};

Frame frameAt(std::span<const std::byte> rest, const Format& format) {
  ByteReader reader(rest, format.order);
  Frame frame;
  if (format.version.major == 3) {
    frame.id = reader.u8();
    frame.bytes = reader.u8();
  } else {
    frame.bytes = reader.u16();
    frame.id = reader.u16();
  }
  return reader.ok() ? frame : Frame{};
}

// Eight bytes at a time: multiplied by a large odd number, the upper half mixed back into the lower.
uint64_t hashOf(std::span<const std::byte> datagram) {
  constexpr uint64_t kFactor = 0x9e3779b97f4a7c15;
  uint64_t hash = datagram.size();
  const auto mix = [&](uint64_t value) {
    hash = (hash ^ value) * kFactor;
    hash ^= hash >> 32;
  };
  ByteReader reader(datagram, std::endian::native);
  while (reader.remaining() >= sizeof(uint64_t)) mix(reader.u64());
  while (reader.remaining() > 0) mix(reader.u8());
  return hash;
}

class MessageReader {
 public:
  explicit MessageReader(const Format& format) { message_.format = format; }

  void packet(std::span<const std::byte> bytes, uint16_t id) {
    if (!readAny<0>(bytes, id)) ++message_.unknown;
    isFirst_ = false;
  }

  void reject(const std::string& why) {
    if (message_.rejected++ == 0) message_.firstRejection = why;
  }

  Message take() { return std::move(message_); }

 private:
  template <size_t alternative>
  bool readAny(std::span<const std::byte> bytes, uint16_t id) {
    if constexpr (alternative == std::variant_size_v<Packet>)
      return false;
    else
      return read(std::variant_alternative_t<alternative, Packet>{}, bytes, id) || readAny<alternative + 1>(bytes, id);
  }

  // False when the id is another packet's.
  template <class T>
  bool read(T packet, std::span<const std::byte> bytes, uint16_t id) {
    const Shape& shape = kShape<T>;
    if (id != shape.id(message_.format.version)) return false;
    if (kIsHeader<T> && !isFirst_)
      reject(fmt::format("{}: the message has one already", shape.name(message_.format.version)));
    else if (fill(packet, bytes))
      message_.packets.emplace_back(packet);
    return true;
  }

  bool read(Entity entity, std::span<const std::byte> bytes, uint16_t id) {
    const Version version = message_.format.version;
    const bool hasTraits = id == kShape<EntityTraits>.id(version), hasPlace = id == kShape<EntityPlace>.id(version);
    if (!hasTraits && !hasPlace) return false;
    if (hasTraits && !fill(entity.traits.emplace(), bytes)) return true;
    if (hasPlace && !fill(entity.place.emplace(), bytes)) return true;
    FieldReader(bytes, message_.format).u16(kEntityId, entity.id);
    message_.packets.emplace_back(entity);
    return true;
  }

  template <class T>
  bool fill(T& packet, std::span<const std::byte> bytes) {
    const Shape& shape = kShape<T>;
    const size_t expected = shape.bytes(message_.format.version);
    if (bytes.size() < expected) {
      reject(fmt::format("{} has {} bytes instead of {}", shape.name(message_.format.version), bytes.size(), expected));
      return false;
    }
    if constexpr (kIsHeader<T>)
      if (isSince(message_.format.version, 2)) otherSidesFrame(packet).emplace();
    FieldReader reader(bytes, message_.format);
    layout(reader, packet);
    if (reader.problem()) reject(fmt::format("{}: {}", shape.name(message_.format.version), *reader.problem()));
    return !reader.problem();
  }

  Message message_;
  bool isFirst_ = true;
};

}  // namespace

std::span<const DatagramShape> hostShapes() {
  return kHostShapes;
}

bool looksLikeCigi(std::span<const std::byte> datagram) {
  return formatOf(datagram).has_value();
}

Result<Message> parse(std::span<const std::byte> datagram) {
  const auto format = formatOf(datagram);
  if (!format) return tl::unexpected(format.error());

  MessageReader reader(*format);
  size_t position = 0;
  for (size_t count = 0; position < datagram.size(); ++count) {
    const auto rest = datagram.subspan(position);
    const Frame frame = frameAt(rest, *format);
    // Without a size that can be believed nothing tells where the next packet begins.
    if (frame.bytes < kMinPacketBytes || frame.bytes > rest.size()) {
      reader.reject(fmt::format("the packet at byte {} says that it has {} bytes; {} are there", position, frame.bytes,
                                rest.size()));
      break;
    }
    if (count == kMaxPackets) {
      reader.reject(fmt::format("the message has more than {} packets", kMaxPackets));
      break;
    }
    reader.packet(rest.first(frame.bytes), frame.id);
    position += frame.bytes;
  }
  Message message = reader.take();
  if (std::ranges::any_of(message.packets, isRequest)) message.requestsHash = hashOf(datagram);
  return message;
}

}  // namespace eye::cigi
