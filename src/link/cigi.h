// CIGI messages, versions 3.0 to 3.3 and 4.0 in either byte order: datagrams to packets and packets to datagrams.
// Pure functions; what packets mean over time is not known here. docs/PROTOCOLS.md has the tables and the errors.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "link/cigi_fields.h"
#include "link/cigi_packets.h"
#include "link/datagram_shape.h"

namespace eye::cigi {

// Twice what the largest datagram of a busy host holds; bounds what a datagram can make the receiver do.
inline constexpr size_t kMaxPackets = 2048;

struct Message {
  Format format;                // as the sender wrote it, for answers
  std::vector<Packet> packets;  // those that are understood and believed, in their order
  uint32_t unknown = 0;         // passed over by their size
  uint32_t rejected = 0;        // cut off, out of range or not where they belong
  std::string firstRejection;   // in words, of the first of these
  // A hash of the whole datagram, where it has requests: by it the same one is known when it comes again.
  std::optional<uint64_t> requestsHash;
};

// True when the first bytes are those of CIGI 3.x or 4.x, whatever else is in the datagram.
bool looksLikeCigi(std::span<const std::byte> datagram);

// A message that parse() understands and that begins with an IG Control which it believes has one of these.
std::span<const DatagramShape> hostShapes();

// An error when the datagram as a whole is no CIGI of a supported version; a bad packet only counts as rejected.
// Nothing of the datagram is referred to afterwards. A message whose header is rejected has the other packets still.
Result<Message> parse(std::span<const std::byte> datagram);

// Beyond this a datagram is cut into fragments on Ethernet, and one lost fragment loses all.
inline constexpr size_t kMaxMessageBytes = 1472;
// Of a message that takes this upon itself to say much at once: what UDP can carry, a thousand answers and more.
inline constexpr size_t kMaxLongMessageBytes = 65000;

// Puts a message together, header first, in a format that parse() knows: that of a message received, or a host's
// choice.
class Builder {
 public:
  Builder(const Format& format, const IgControl& header, size_t maxBytes = kMaxMessageBytes);
  Builder(const Format& format, const StartOfFrame& header, size_t maxBytes = kMaxMessageBytes);

  // False when it no longer fits: then send what is there and begin another message. `packet` is no header. An Entity
  // in 3.x has a place, its traits default to an active, opaque one; in 4.0 it has at least one of the two.
  bool add(const Packet& packet);

  size_t size() const { return bytes_.size(); }
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  Format format_;
  size_t maxBytes_;
  std::vector<std::byte> bytes_;
};

}  // namespace eye::cigi
