// native-fdm's clock, which is none with most hosts: FlightGear sends whole seconds and JSBSim a constant, or the
// simulation's time in ticks of a length that the host's files say and the packet does not. Owner thread: link.
#pragma once

#include <optional>

#include "link/host_clock.h"

namespace eye {

// Listens for four seconds how fast the clock runs. Only one that makes 10^3 to 10^9 ticks a second is used, by then
// as a HostClock, which goes on judging it.
class FdmClock {
 public:
  Moment take(uint32_t ticks, int64_t arrivedNs);

 private:
  void measure(uint32_t ticks, int64_t arrivedNs);

  std::optional<HostClock> clock_;
  double tickNs_ = 0;  // of the clock
  // While there is none.
  bool measuring_ = false;
  int64_t beganNs_ = 0, counted_ = 0;  // ticks since then
  uint32_t newest_ = 0;
};

}  // namespace eye
