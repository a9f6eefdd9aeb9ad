// What a bad network does to packets, decided by a seeded generator: the same seed and packets, the same fate.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "base/error.h"

namespace eye {

struct BadLinkOptions {
  double jitterMs = 0;   // each packet is delayed by 0 to this
  double loss = 0;       // probabilities, 0 to 1
  double duplicate = 0;  // sent twice
  double reorder = 0;    // held back until the next one has gone
  uint64_t seed = 1;
};

// Usage error that names the option and its range.
Result<void> checkBadLink(const BadLinkOptions& options);

class BadLink {
 public:
  explicit BadLink(const BadLinkOptions& options) : options_(options), random_(options.seed) {}
  // When the copies of a packet that is due at `dueNs` leave: none, one or two. `periodNs`: the time between packets.
  std::vector<int64_t> departures(int64_t dueNs, int64_t periodNs);

 private:
  bool happens(double probability) { return uniform() < probability; }
  double uniform();  // [0, 1)
  BadLinkOptions options_;
  std::mt19937_64 random_;
};

}  // namespace eye
