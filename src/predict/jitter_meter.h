// How unevenly a host's packets arrive.
#pragma once

#include <cstddef>
#include <vector>

namespace eye {

// Owner: render thread.
class JitterMeter {
 public:
  // Of a host without time stamps: when a packet came, seconds on a clock that never goes back.
  void arrived(double atS);
  // Of one with them: how much longer a packet was under way than the quickest one.
  void heldUp(double byS);
  // 95 % of packets come this much off their usual distance from the one before, or are held up by this much, or less;
  // 0 until there are some. Of the last two seconds or so at 60 Hz.
  double jitterS() const { return jitterS_; }

 private:
  enum class Kind { none, gaps, delays };
  void keep(Kind kind, double valueS);
  double quantile(double q);  // of `sorted_`

  static constexpr size_t kKept = 128;
  Kind kind_ = Kind::none;
  std::vector<double> valuesS_;  // a ring
  size_t next_ = 0;
  double lastS_ = -1, jitterS_ = 0;
  std::vector<double> sorted_;
};

}  // namespace eye
