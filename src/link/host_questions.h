// What a host asks of the ground as it flies: heights under the aircraft, what is ahead of it.
#pragma once

#include <string>
#include <vector>

#include "base/error.h"
#include "link/cigi_packets.h"

namespace eye::cigi {

enum class Ask : uint8_t { hat, hot, hatHot, los, losExtended };
// Names as on the command line, "hat,los" or one by one: hat, hot, hat-hot, los, los-extended.
Result<std::vector<Ask>> parseAsks(const std::vector<std::string>& names);

struct AskPlan {
  std::vector<Ask> asks;
  int everyFrames = 60;     // 1 to 255: the update period of the requests
  uint32_t firstFrame = 0;  // the host's first
  bool empty() const { return asks.empty(); }
};

inline constexpr double kAheadM = 20'000;  // how far a line of sight looks

// The requests that go with a host frame; the image generator repeats them by itself, and they are sent again now and
// then for one that has begun anew. Points are entity 0's own, so that they go with it.
std::vector<Packet> requestsAt(const AskPlan& plan, uint32_t hostFrame);

}  // namespace eye::cigi
