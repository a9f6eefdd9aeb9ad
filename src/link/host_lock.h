// Who steers: of the senders that are allowed, the first one that is understood, until it has been silent for a while.
// Owner thread: link.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <optional>

#include "link/host_url.h"

namespace eye {

// A host sends many times a second; another one, or itself from another port after a restart, waits this long.
inline constexpr int64_t kHostSilenceNs = 2'000'000'000;

class HostLock {
 public:
  explicit HostLock(AllowList allowed = {}, int64_t silenceNs = kHostSilenceNs)
      : allowed_(std::move(allowed)), silenceNs_(silenceNs) {}

  bool isAllowed(const Peer& sender) const { return allowed_.allows(sender); }
  // False while another host speaks.
  bool mayPass(const Peer& sender, int64_t nowNs) const {
    return !host_ || *host_ == sender || nowNs - heardNs_ > silenceNs_;
  }
  // The host, while nobody else may pass for half of the silence yet: those who are kept away from the socket until
  // then lose nothing.
  std::optional<Peer> speaker(int64_t nowNs) const { return nowNs - heardNs_ <= silenceNs_ / 2 ? host_ : std::nullopt; }
  // Of one that may pass and was understood. True when it was not the host before.
  bool heard(const Peer& sender, int64_t nowNs) {
    const bool isNew = !host_ || *host_ != sender;
    host_ = sender;
    heardNs_ = nowNs;
    return isNew;
  }

  // Why the sender's datagram is not looked at.
  tl::unexpected<Error> refusal(const Peer& sender) const {
    if (!isAllowed(sender)) return notAllowed(sender);
    return fail(ErrorKind::badData,
                fmt::format("{} is not heard while {} speaks", toText(sender), toText(host_.value_or(Peer{}))));
  }

 private:
  AllowList allowed_;
  int64_t silenceNs_;
  std::optional<Peer> host_;
  int64_t heardNs_ = 0;
};

}  // namespace eye
