// The host's side of a link: packets at their moments, in real time.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "geo/pose.h"
#include "link/bad_link.h"
#include "link/cigi_fields.h"
#include "link/host_questions.h"
#include "link/track_file.h"
#include "link/udp_socket.h"

namespace eye {

// A round of packets, which may be flown again and again.
struct PacketSource {
  uint64_t count = 0;                                      // packets in a round, at least 1
  double roundS = 0;                                       // from the first packet of a round to the first of the next
  std::function<RecordedPacket(uint64_t index)> packetAt;  // index < count; times do not decrease
};

// native-fdm packets of poses `rateHz` times a second, from 0 to `durationS` inclusive.
PacketSource packetsFromPoses(std::function<Pose(double timeS)> poseAt, double durationS, double rateHz);
// CIGI host messages of the same poses; `igFrame` says which of the image generator's frames has come in last, and
// `plan` what is asked of the ground. Frame numbers go on from round to round.
PacketSource cigiPacketsFromPoses(std::function<Pose(double timeS)> poseAt, double durationS, double rateHz,
                                  cigi::Version version, std::function<uint32_t()> igFrame,
                                  const cigi::AskPlan& plan = {});
// Recorded packets, payload and timing unchanged. There must be at least one.
PacketSource packetsFromRecording(std::vector<RecordedPacket> packets);

struct SendOptions {
  bool loop = false;
  std::optional<double> durationS;  // stop after; without it at the end of the round, or never with `loop`
  BadLinkOptions badLink;
};

struct SendReport {
  double elapsedS = 0;
  uint64_t packets = 0;        // taken from the source
  uint64_t datagrams = 0;      // handed to the network: without what was lost on purpose, with duplicates
  uint64_t lost = 0;           // on purpose
  uint64_t duplicated = 0;     // on purpose
  uint64_t failed = 0;         // not taken by the network
  bool nobodyListens = false;  // as far as the other machine says so
  std::optional<Pose> pose;    // in the newest packet sent
};

// Sends until the end or until `stop`; `everySecond` is called about once a second. Deadlines are counted from the
// start, so that the rate does not drift. Blocks; runs on the calling thread.
SendReport sendPackets(const PacketSource& source, const UdpSocket& socket, const SendOptions& options,
                       const std::atomic<bool>& stop, const std::function<void(const SendReport&)>& everySecond);

// Packets on demand: one for each time that `awaitDemand` (which waits so many milliseconds at most) returns true, but
// `leastS` after the one before, and one each `patienceS` while it does not. `packetAt` has nothing at the end;
// `demanded` tells it which of the two it is.
struct DemandedSource {
  std::function<std::optional<std::vector<std::byte>>(double timeS, bool demanded)> packetAt;
  std::function<bool(int timeoutMs)> awaitDemand;
  double leastS = 0, patienceS = 1;
};
SendReport sendOnDemand(const DemandedSource& source, const UdpSocket& socket, const SendOptions& options,
                        const std::atomic<bool>& stop, const std::function<void(const SendReport&)>& everySecond);

}  // namespace eye
