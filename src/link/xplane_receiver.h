// What X-Plane's RPOS says over time, and that it is asked for it. The interface: link/receiver.h.
#pragma once

#include <algorithm>

#include "link/receiver.h"
#include "link/xplane.h"

namespace eye {

class XplaneReceiver : public ListeningReceiver {
 public:
  using Message = RposState;
  using State = RposState;

  XplaneReceiver(const Peer& xplane, int rateHz) : xplane_(xplane), rateHz_(rateHz) {}

  Result<Message> parse(std::span<const std::byte> datagram) const { return parseRpos(datagram); }
  static std::span<const DatagramShape> shapes() { return rposShapes(); }
  bool concerns(const Message&, int64_t) const { return true; }
  void reset() {}
  std::string greeting(const Message&) const { return "is X-Plane"; }
  Taken take(const Message& message, const Peer&, int64_t nowNs) {  // the protocol has no clock
    state_ = message;
    heardNs_ = nowNs;
    return {Moment{nowNs}, {}};
  }
  const State& state() const { return state_; }

  static std::optional<Pose> poseAt(const State& state, int64_t) { return state.pose; }
  static bool moves(const State&) { return false; }
  static void tell(const State&, int64_t, SourceSample&) {}

  // Asks again while it is silent.
  std::optional<Outgoing> due(int64_t nowNs) {
    constexpr int64_t kAskAgainNs = 1'000'000'000;
    if (nowNs - std::max(heardNs_, askedNs_) < kAskAgainNs) return std::nullopt;
    askedNs_ = nowNs;
    return Outgoing{xplane_, buildRposRequest(rateHz_)};
  }
  std::optional<Outgoing> farewell(int64_t) { return Outgoing{xplane_, buildRposRequest(0)}; }

 private:
  Peer xplane_;
  int rateHz_;
  int64_t heardNs_ = 0, askedNs_ = 0;
  State state_;
};

}  // namespace eye
