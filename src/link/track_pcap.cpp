#include <fmt/format.h>

#include <algorithm>

#include "link/cigi_host.h"
#include "link/cigi_session.h"
#include "link/native_fdm.h"
#include "link/pcap.h"
#include "link/track_file.h"

namespace eye {
namespace {

bool toSamePlace(const CapturedDatagram& a, const CapturedDatagram& b) {
  return a.destination == b.destination && a.destinationPort == b.destinationPort;
}

bool isOf(RecordedProtocol protocol, std::span<const std::byte> payload) {
  return protocol == RecordedProtocol::cigi ? cigi::isFromHost(payload) : looksLikeNativeFdm(payload);
}

// None of the datagrams is `wanted`; a version of CIGI that is not understood is the likeliest reason.
tl::unexpected<Error> noneIs(const std::string& wanted, const std::vector<CapturedDatagram>& datagrams) {
  std::string message = fmt::format("none of the capture's {} UDP datagrams is {}", datagrams.size(), wanted);
  for (const CapturedDatagram& datagram : datagrams) {
    const auto parsed = cigi::parse(datagram.payload);
    if (parsed || parsed.error().kind != ErrorKind::unsupported) continue;
    message += ": " + parsed.error().message;
    break;
  }
  return fail(ErrorKind::badData, message);
}

std::string nativeFdmPacket() {
  return fmt::format("a native-fdm packet (version 24 with {} bytes or 25 with {})", kNativeFdmBytesV24,
                     kNativeFdmBytesV25);
}

// The datagrams of the capture's first stream of a protocol.
Result<std::vector<CapturedDatagram>> streamOf(Capture capture, RecordedProtocol protocol) {
  auto& datagrams = capture.datagrams;
  const auto first =
      std::ranges::find_if(datagrams, [&](const CapturedDatagram& d) { return isOf(protocol, d.payload); });
  if (first == datagrams.end())
    return noneIs(protocol == RecordedProtocol::cigi ? "a CIGI host's message" : nativeFdmPacket(), datagrams);
  const CapturedDatagram stream = *first;
  std::erase_if(datagrams,
                [&](const CapturedDatagram& d) { return !isOf(protocol, d.payload) || !toSamePlace(d, stream); });
  return std::move(datagrams);
}

Result<RecordedProtocol> protocolIn(const Capture& capture) {
  for (const CapturedDatagram& datagram : capture.datagrams)
    for (const RecordedProtocol protocol : {RecordedProtocol::nativeFdm, RecordedProtocol::cigi})
      if (isOf(protocol, datagram.payload)) return protocol;
  return noneIs(nativeFdmPacket() + " or a CIGI host's message", capture.datagrams);
}

double secondsBetween(const CapturedDatagram& from, const CapturedDatagram& to) {
  return static_cast<double>(to.timeNs - from.timeNs) * 1e-9;
}

// What a session of CIGI shows after each of its datagrams.
class CigiPoses {
 public:
  Result<Pose> after(const CapturedDatagram& datagram) {
    const auto message = cigi::parse(datagram.payload);
    if (!message) return tl::unexpected(message.error());
    session_.take(*message, datagram.timeNs, "recording");
    const auto pose = poseOf(session_.snapshot().eye, datagram.timeNs);
    if (!pose) return fail(ErrorKind::badData, "the eye's entity has no place yet, or the mode is standby");
    return *pose;
  }

 private:
  cigi::Session session_{0};
};

Result<Pose> nativeFdmPose(const CapturedDatagram& datagram) {
  const auto state = parseNativeFdm(datagram.payload);
  if (!state) return tl::unexpected(state.error());
  return state->pose;
}

}  // namespace

Result<RecordedProtocol> protocolOf(std::span<const std::byte> file) {
  const auto capture = parsePcap(file);
  if (!capture) return tl::unexpected(capture.error());
  return protocolIn(*capture);
}

Result<Track> parsePcapTrack(std::span<const std::byte> file) {
  auto capture = parsePcap(file);
  if (!capture) return tl::unexpected(capture.error());
  const auto protocol = protocolIn(*capture);
  if (!protocol) return tl::unexpected(protocol.error());
  const auto stream = streamOf(std::move(*capture), *protocol);
  if (!stream) return tl::unexpected(stream.error());
  CigiPoses cigiPoses;
  std::vector<TrackSample> samples;
  std::string lastReason;
  for (const CapturedDatagram& datagram : *stream) {
    const auto pose = *protocol == RecordedProtocol::cigi ? cigiPoses.after(datagram) : nativeFdmPose(datagram);
    if (!pose) {
      lastReason = pose.error().message;
      continue;
    }
    const double timeS = secondsBetween(stream->front(), datagram);
    if (!samples.empty() && timeS <= samples.back().timeS) continue;  // the capturing clock stood still or was set back
    if (samples.size() == kMaxTrackSamples)
      return fail(ErrorKind::badData,
                  fmt::format("more than {} packets; cut the capture with editcap", kMaxTrackSamples));
    samples.push_back({timeS, *pose});
  }
  if (samples.empty())
    return fail(ErrorKind::badData,
                fmt::format("none of the capture's {} {} packets is usable; the last one: {}", stream->size(),
                            *protocol == RecordedProtocol::cigi ? "CIGI" : "native-fdm", lastReason));
  return Track(std::move(samples));
}

Result<std::vector<RecordedPacket>> parsePcapPackets(std::span<const std::byte> file, RecordedProtocol protocol) {
  auto capture = parsePcap(file);
  if (!capture) return tl::unexpected(capture.error());
  const auto stream = streamOf(std::move(*capture), protocol);
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
