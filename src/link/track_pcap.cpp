#include <fmt/format.h>

#include <algorithm>

#include "link/native_fdm.h"
#include "link/pcap.h"
#include "link/track_file.h"

namespace eye {
namespace {

bool toSamePlace(const CapturedDatagram& a, const CapturedDatagram& b) {
  return a.destination == b.destination && a.destinationPort == b.destinationPort;
}

// The datagrams of the capture's first native-fdm stream.
Result<std::vector<CapturedDatagram>> nativeFdmStream(std::span<const std::byte> file) {
  auto capture = parsePcap(file);
  if (!capture) return tl::unexpected(capture.error());
  auto& datagrams = capture->datagrams;
  const auto first = std::find_if(datagrams.begin(), datagrams.end(),
                                  [](const CapturedDatagram& d) { return looksLikeNativeFdm(d.payload); });
  if (first == datagrams.end())
    return fail(ErrorKind::badData, fmt::format("none of the capture's {} UDP datagrams is a native-fdm packet "
                                                "(version 24 with {} bytes or 25 with {})",
                                                datagrams.size(), kNativeFdmBytesV24, kNativeFdmBytesV25));
  const CapturedDatagram stream = *first;
  std::erase_if(datagrams,
                [&](const CapturedDatagram& d) { return !looksLikeNativeFdm(d.payload) || !toSamePlace(d, stream); });
  return std::move(datagrams);
}

double secondsBetween(const CapturedDatagram& from, const CapturedDatagram& to) {
  return static_cast<double>(to.timeNs - from.timeNs) * 1e-9;
}

}  // namespace

Result<Track> parsePcapTrack(std::span<const std::byte> file) {
  const auto stream = nativeFdmStream(file);
  if (!stream) return tl::unexpected(stream.error());
  std::vector<TrackSample> samples;
  std::string lastReason;
  for (const CapturedDatagram& datagram : *stream) {
    const auto state = parseNativeFdm(datagram.payload);
    if (!state) {
      lastReason = state.error().message;
      continue;
    }
    const double timeS = secondsBetween(stream->front(), datagram);
    if (!samples.empty() && timeS <= samples.back().timeS) continue;  // the capturing clock stood still or was set back
    if (samples.size() == kMaxTrackSamples)
      return fail(ErrorKind::badData,
                  fmt::format("more than {} packets; cut the capture with editcap", kMaxTrackSamples));
    samples.push_back({timeS, state->pose});
  }
  if (samples.empty())
    return fail(ErrorKind::badData,
                fmt::format("none of the capture's {} native-fdm packets is usable; the last one: {}", stream->size(),
                            lastReason));
  return Track(std::move(samples));
}

Result<std::vector<RecordedPacket>> parsePcapPackets(std::span<const std::byte> file) {
  const auto stream = nativeFdmStream(file);
  if (!stream) return tl::unexpected(stream.error());
  std::vector<RecordedPacket> packets;
  double latestS = 0;
  for (const CapturedDatagram& datagram : *stream) {
    latestS = std::max(latestS, secondsBetween(stream->front(), datagram));
    packets.push_back({latestS, {datagram.payload.begin(), datagram.payload.end()}});
  }
  return packets;
}

}  // namespace eye
