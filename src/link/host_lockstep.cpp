#include "link/host_lockstep.h"

#include <spdlog/spdlog.h>

namespace eye::cigi {

std::optional<std::vector<std::byte>> Lockstep::packetAt(double timeS, bool demanded) {
  if (frame_ > 0 && !demanded) {
    const HostChannels channels = replies_.channels();
    ++resent_;
    if (!channels.complete()) {
      if (resent_ % kResends == 0)
        spdlog::warn("{} of {} channels have answered so far: waiting for the others", channels.known(), channels_);
      return last_;
    }
    const std::vector<Peer> behind = channels.behind(frame_);
    if (resent_ >= kResends) {
      for (const Peer& channel : behind) {
        spdlog::warn("channel {} has not shown host frame {} for {:g} s: going on without it", toText(channel), frame_,
                     kResends * kResendS);
        replies_.giveUp(channel);
      }
    }
    return last_;  // those that are left demand the next one at once; where none is, it waits for one
  }
  resent_ = 0;
  last_ = messageOf_(++frame_, timeS);
  return last_;
}

}  // namespace eye::cigi
