// The newest aircraft state and the mailbox through which it reaches the frame.
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>

#include "geo/pose.h"

namespace eye {

struct HostState {
  Pose pose;
  int64_t arrivedNs = 0;            // monotonicNs() when the packet that carried it came in
  std::optional<double> hostTimeS;  // the host's own clock where the protocol has one
  std::optional<double> visibilityM;
};

struct HostCounts {
  uint64_t packets = 0;   // datagrams received, good and bad
  uint64_t rejected = 0;  // wrong size, version, NaN, out of range
  uint64_t lost = 0;      // gaps in the protocol's own numbering, where it has one
};

// A latest-value mailbox: one writer (the link thread), one reader (the frame).
class Mailbox {
 public:
  void put(const HostState& state);
  void count(const HostCounts& counts);
  struct Snapshot {
    std::optional<HostState> state;
    HostCounts counts;
  };
  Snapshot take() const;

 private:
  mutable std::mutex mutex_;
  Snapshot latest_;
};

}  // namespace eye
