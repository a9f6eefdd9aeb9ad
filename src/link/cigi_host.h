// The host's side of CIGI: messages of poses, and what the image generator says back.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

#include "link/cigi.h"
#include "link/host_channels.h"
#include "link/udp_socket.h"

namespace eye::cigi {

// One message: the mode is operate, and entity 0 is at the pose.
struct HostFrame {
  uint32_t number = 0;
  uint32_t igFrame = 0;  // the last that has come in
  double timeS = 0;      // of the host's clock
  Pose pose;
  std::vector<Packet> requests = {};  // what it asks; a handful
};
std::vector<std::byte> hostMessage(Version version, const HostFrame& frame);

// Where the first entity of a host's message is; nothing where it has none, or one that is attached to another.
std::optional<Pose> entityPoseIn(std::span<const std::byte> datagram);

// True for a datagram that begins with IG Control, whatever else is in it.
bool isFromHost(std::span<const std::byte> datagram);

struct HeardReplies {
  uint64_t starts = 0;  // of frames
  uint64_t heights = 0, sights = 0;
  uint64_t notUnderstood = 0;
  uint64_t overframings = 0, pagings = 0;  // frames that said so
  StartOfFrame newest;
};

// Listens on a socket from connectTo until it is destroyed, which takes at most some 20 ms. The socket must live
// longer.
class ReplyListener {
 public:
  // `onMessage` (may be empty) gets what is understood, on the listener's thread. `channels`: how many are expected.
  using OnMessage = std::function<void(const Peer& sender, const Message& message)>;
  explicit ReplyListener(const UdpSocket& socket, size_t channels = 1, OnMessage onMessage = {});
  HeardReplies heard() const;
  uint32_t igFrame() const { return igFrame_; }  // the newest that has come in
  // Waits for a Start of Frame that came after the last call; false after the time.
  bool awaitStart(int timeoutMs);

  // Waits until all channels have shown the host's frame, but for those that were given up; false after the time.
  bool awaitChannels(uint32_t hostFrame, int timeoutMs);
  HostChannels channels() const;
  void giveUp(const Peer& channel);  // until it is heard again

 private:
  void run(const std::stop_token& stop);
  void take(std::span<const std::byte> datagram, const Peer& sender);

  const UdpSocket& socket_;
  const OnMessage onMessage_;
  mutable std::mutex mutex_;
  std::condition_variable came_;
  HeardReplies heard_;
  HostChannels channels_;
  uint64_t awaited_ = 0;  // starts that awaitStart has seen
  std::atomic<uint32_t> igFrame_ = 0;
  std::jthread thread_;  // last: it uses the others
};

}  // namespace eye::cigi
