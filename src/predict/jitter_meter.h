// How unevenly a host's packets arrive.
#pragma once

#include <cstddef>
#include <vector>

namespace eye {

// Owner: render thread.
class JitterMeter {
 public:
  // Arrival of the newest packet, seconds on a clock that never goes back.
  void observe(double arrivedS);
  // 95 % of packets come this much off their usual distance from the one before, or less; 0 until there are some.
  // Of the last two seconds or so at 60 Hz.
  double jitterS() const { return jitterS_; }

 private:
  static constexpr size_t kKept = 128;
  std::vector<double> gapsS_;  // a ring
  size_t next_ = 0;
  double lastS_ = -1, jitterS_ = 0;
  std::vector<double> sorted_;
};

}  // namespace eye
