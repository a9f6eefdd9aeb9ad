// Who steers: the first host that is understood, until it has been silent for a while. Owner thread: link.
#pragma once

#include <cstdint>
#include <optional>

#include "link/udp_socket.h"

namespace eye {

// A host sends many times a second; another one, or itself from another port after a restart, waits this long.
inline constexpr int64_t kHostSilenceNs = 2'000'000'000;

class HostLock {
 public:
  // False while another host speaks.
  bool mayPass(const Peer& sender, int64_t nowNs) const {
    return !host_ || *host_ == sender || nowNs - heardNs_ > kHostSilenceNs;
  }
  // Of one that may pass and was understood. True when it was not the host before.
  bool heard(const Peer& sender, int64_t nowNs) {
    const bool isNew = !host_ || *host_ != sender;
    host_ = sender;
    heardNs_ = nowNs;
    return isNew;
  }
  const std::optional<Peer>& host() const { return host_; }

 private:
  std::optional<Peer> host_;
  int64_t heardNs_ = 0;
};

}  // namespace eye
