#include <array>

#include "link/cigi.h"
#include "link/cigi_layout_environment.h"
#include "link/cigi_layout_host.h"
#include "link/cigi_layout_ig.h"
#include "link/cigi_shapes.h"

namespace eye::cigi {
namespace {

using PacketBytes = std::array<std::byte, kMaxBuiltBytes>;

bool isOld(Version version) {
  return !isSince(version, 2);
}

// Size and id; returns the packet's bytes, which are 0 otherwise.
template <class T>
std::span<std::byte> begin(PacketBytes& bytes, const Format& format) {
  const Shape& shape = kShape<T>;
  const size_t size = shape.bytes(format.version);
  if (format.version.major == 3) {
    bytes[0] = static_cast<std::byte>(shape.id3);
    bytes[1] = static_cast<std::byte>(size);
  } else {
    const bool big = format.order == std::endian::big;
    bytes[big ? 1 : 0] = static_cast<std::byte>(size);
    bytes[big ? 2 : 3] = static_cast<std::byte>(shape.id4 >> 8);
    bytes[big ? 3 : 2] = static_cast<std::byte>(shape.id4 & 0xff);
  }
  return std::span(bytes).first(size);
}

// `minorAt3`: the byte that has the minor version in its upper half in 3.2 and 3.3. 3.0 and 3.1 reserve it as 0.
template <class T>
std::vector<std::byte> headerBytes(T header, const Format& format, uint8_t minorAt3) {
  EYE_CHECK((format.version.major == 3 && format.version.minor <= kNewestMinor3) || format.version.major == 4);
  if (isOld(format.version))
    otherSidesFrame(header).reset();
  else if (!otherSidesFrame(header))
    otherSidesFrame(header) = 0;
  PacketBytes bytes{};
  const auto packet = begin<T>(bytes, format);
  FieldWriter writer(packet, format);
  layout(writer, std::as_const(header));
  writer.u8({2, 4}, format.version.major);
  writer.bits({minorAt3, 7}, 0xf0, isOld(format.version) ? uint8_t{0} : format.version.minor);
  writer.u16({6, kAbsent}, 0x8000);  // read as 0x0080 by who has the other order
  return {packet.begin(), packet.end()};
}

template <class T>
void appendPacket(std::vector<std::byte>& to, const T& packet, const Format& format) {
  static_assert(!kIsHeader<T>);
  PacketBytes bytes{};
  const auto filled = begin<T>(bytes, format);
  FieldWriter writer(filled, format);
  layout(writer, packet);
  to.insert(to.end(), filled.begin(), filled.end());
}

template <class T>
void appendPart(std::vector<std::byte>& to, uint16_t entityId, const T& part, const Format& format) {
  const size_t at = to.size();
  appendPacket(to, part, format);
  FieldWriter writer{std::span(to).subspan(at), format};
  writer.u16(kEntityId, entityId);
}

void appendPacket(std::vector<std::byte>& to, const Entity& entity, const Format& format) {
  if (format.version.major == 4) {
    if (entity.traits) appendPart(to, entity.id, *entity.traits, format);
    if (entity.place) appendPart(to, entity.id, *entity.place, format);
    return;
  }
  EYE_CHECK(entity.place);  // without it the packet would move the entity to latitude and longitude 0
  const size_t at = to.size();
  appendPart(to, entity.id, *entity.place, format);
  FieldWriter writer{std::span(to).subspan(at), format};
  layout(writer, entity.traits.value_or(EntityTraits{}));
}

}  // namespace

Builder::Builder(const Format& format, const IgControl& header, size_t maxBytes)
    : format_(format), maxBytes_(maxBytes), bytes_(headerBytes(header, format, 4)) {}

Builder::Builder(const Format& format, const StartOfFrame& header, size_t maxBytes)
    : format_(format), maxBytes_(maxBytes), bytes_(headerBytes(header, format, 5)) {}

bool Builder::add(const Packet& packet) {
  const size_t before = bytes_.size();
  std::visit(
      [&](const auto& p) {
        if constexpr (kIsHeader<std::decay_t<decltype(p)>>)
          checkFailed("a message has one header", __FILE__, __LINE__);
        else
          appendPacket(bytes_, p, format_);
      },
      packet);
  if (bytes_.size() <= maxBytes_) return true;
  bytes_.resize(before);
  return false;
}

}  // namespace eye::cigi
