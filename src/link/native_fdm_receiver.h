// What native-fdm's packets say over time. The interface: link/receiver.h.
#pragma once

#include "link/fdm_clock.h"
#include "link/native_fdm.h"
#include "link/receiver.h"

namespace eye {

class NativeFdmReceiver : public ListeningReceiver {
 public:
  using Message = NativeFdmState;
  using State = NativeFdmState;

  Result<Message> parse(std::span<const std::byte> datagram) const { return parseNativeFdm(datagram); }
  static std::span<const DatagramShape> shapes() { return nativeFdmShapes(); }
  bool concerns(const Message&, int64_t) const { return true; }
  void reset() { clock_ = {}; }
  std::string greeting(const Message&) const { return "speaks native-fdm"; }
  Taken take(const Message& message, const Peer&, int64_t nowNs) {
    const Moment moment = clock_.take(message.clockTicks, nowNs);
    if (moment.overtaken) return {};
    state_ = message;
    return {moment, {}};
  }
  const State& state() const { return state_; }

  static std::optional<Pose> poseAt(const State& state, int64_t) { return state.pose; }
  static bool moves(const State&) { return false; }
  static void tell(const State& state, int64_t, SourceSample& sample) { sample.visibilityM = state.visibilityM; }

 private:
  FdmClock clock_;
  State state_;
};

}  // namespace eye
