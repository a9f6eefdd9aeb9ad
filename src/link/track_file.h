// Track files: CSV, IGC and pcap, described in docs/PROTOCOLS.md. The parsers are pure: text or bytes in, a track or an
// error with its line out.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "link/track.h"

namespace eye {

inline constexpr size_t kMaxTrackFileBytes = 64u << 20;

// Header line `time,lat,lon,alt,heading,pitch,roll` in any order (seconds, degrees, metres); the last three may be
// missing, further columns are ignored.
Result<Track> parseCsvTrack(std::string_view text);
// Flight recorder files of gliders (FAI IGC): B records.
Result<Track> parseIgcTrack(std::string_view text);
// The native-fdm or CIGI packets of a capture, whichever it has first, on the capture's time stamps. Of CIGI, what view
// 0 sees: the poses of a host's session.
Result<Track> parsePcapTrack(std::span<const std::byte> file);

// One packet of a recording, to be sent again as it was.
struct RecordedPacket {
  double timeS = 0;  // since the first; never decreases
  std::vector<std::byte> payload;
};
enum class RecordedProtocol { nativeFdm, cigi };
// The first of the two whose packets a capture has; of CIGI a host's count, not an image generator's.
Result<RecordedProtocol> protocolOf(std::span<const std::byte> file);
// The packets of the protocol in a capture, good and bad, of the one address and port to which the first of them went.
Result<std::vector<RecordedPacket>> parsePcapPackets(std::span<const std::byte> file, RecordedProtocol protocol);

// Reads a file of at most kMaxTrackFileBytes.
Result<std::vector<std::byte>> readTrackFile(const std::string& path);
bool isCapture(std::span<const std::byte> file);
// Any of the three; which one is told by the content, and by the name's end for IGC. Errors begin with the path.
Result<Track> loadTrack(const std::string& path);

}  // namespace eye
