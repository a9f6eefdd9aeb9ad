#include "link/host_channels.h"

#include <algorithm>
#include <utility>

namespace eye::cigi {
namespace {

// More would be a mistake or an attack: a channel that begins anew from another port is a new one.
constexpr size_t kMostChannels = 256;

}  // namespace

bool HostChannels::heard(const Peer& channel, uint32_t hostFrame, bool operates) {
  const auto found = std::ranges::find(channels_, channel, &Channel::peer);
  if (found == channels_.end()) {
    if (channels_.size() < kMostChannels) channels_.push_back({channel, hostFrame, false, operates});
    return false;
  }
  if (std::exchange(found->operated, operates) && !operates) {
    found->givenUp = true;
    return false;
  }
  found->hostFrame = hostFrame;
  return std::exchange(found->givenUp, false);
}

bool HostChannels::someAreHeard() const {
  return std::ranges::any_of(channels_, [](const Channel& channel) { return !channel.givenUp; });
}

std::vector<Peer> HostChannels::behind(uint32_t frame) const {
  std::vector<Peer> peers;
  for (const Channel& channel : channels_)
    if (!channel.givenUp && static_cast<int32_t>(channel.hostFrame - frame) < 0) peers.push_back(channel.peer);
  return peers;
}

void HostChannels::giveUp(const Peer& channel) {
  const auto found = std::ranges::find(channels_, channel, &Channel::peer);
  if (found != channels_.end()) found->givenUp = true;
}

}  // namespace eye::cigi
