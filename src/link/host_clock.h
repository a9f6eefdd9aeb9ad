// A host's time stamps on this machine's clock. Owner thread: link.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace eye {

// When what a packet says was true, on this machine's clock.
struct Moment {
  int64_t atNs = 0;        // the arrival, or before it by what the network held the packet up
  bool byHost = false;     // from the host's stamp, else the arrival
  bool overtaken = false;  // a packet that was sent later has come before
};

// arrival = stamp + offset + delay. The least difference of the last seconds is of a packet that nothing has held up,
// so it is the offset and the least delay, of which one side alone cannot know more (the clock filter of NTP, RFC
// 5905). A slow drift is followed, since old differences are forgotten; a clock that is set, stands, or does not run at
// this machine's rate is not believed: arrivals count then, until it has run evenly for two seconds.
class HostClock {
 public:
  // Stamps count from 0 to below `wrapNs` and begin again.
  explicit HostClock(int64_t wrapNs) : wrapNs_(wrapNs) {}

  // The stamp of a packet, and when it came; arrivals never go back. Moments never go back either, but of packets that
  // were overtaken.
  Moment take(int64_t stampNs, int64_t arrivedNs);
  bool believed() const { return believed_; }
  void reset() { *this = HostClock(wrapNs_); }

 private:
  struct Span {
    int64_t beganNs, leastNs;  // arrival minus stamp
  };
  void begin(int64_t stampNs, int64_t arrivedNs);
  bool isOvertaken(int64_t aheadNs, int64_t arrivedNs);
  bool isJump(int64_t offsetNs) const;
  void keep(int64_t offsetNs, int64_t arrivedNs);
  bool runsEvenly() const;
  int64_t leastNs() const;

  int64_t wrapNs_;
  bool started_ = false, believed_ = false;
  int64_t newestNs_ = 0;  // stamp, unwrapped: counts on
  int64_t newestArrivedNs_ = 0, newestAtNs_ = 0;
  int behindRun_ = 0;        // packets behind the newest one, one after another
  std::vector<Span> spans_;  // of a second or more each, the newest last and still open; at most kSpans + 1
};

}  // namespace eye
