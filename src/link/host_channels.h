// Which channels of an image generator have shown which of the host's frames, by the Starts of Frame that they send.
// A channel is known by the address and port that it sends from.
#pragma once

#include <cstdint>
#include <vector>

#include "link/udp_socket.h"

namespace eye::cigi {

class HostChannels {
 public:
  explicit HostChannels(size_t expected) : expected_(expected) {}

  // A Start of Frame. True for one that had been given up. One that operated and says that it does no longer ends.
  bool heard(const Peer& channel, uint32_t hostFrame, bool operates = true);
  // As many channels as are expected have spoken at least once.
  bool complete() const { return channels_.size() >= expected_; }
  // All that are expected have shown the frame or a later one, but for those that were given up; one at least has.
  bool allHave(uint32_t frame) const { return complete() && someAreHeard() && behind(frame).empty(); }
  std::vector<Peer> behind(uint32_t frame) const;  // known ones, not given up
  void giveUp(const Peer& channel);                // until it is heard again

  size_t known() const { return channels_.size(); }

 private:
  bool someAreHeard() const;
  struct Channel {
    Peer peer;
    uint32_t hostFrame = 0;
    bool givenUp = false, operated = false;
  };
  size_t expected_;
  std::vector<Channel> channels_;
};

}  // namespace eye::cigi
