// What the live sources that follow one kind of packet have in common.
#pragma once

#include "link/host_state.h"
#include "link/state_source.h"

namespace eye {

// The newest state of a protocol, as its link thread puts it into the mailbox.
template <class State>
struct Arrived {
  State state;
  int64_t arrivedNs = 0;
};

// A frame's sample of a live host but for what only its protocol knows; not valid before the first state.
template <class Snapshot>
SourceSample liveSample(const Snapshot& newest) {
  SourceSample sample;
  sample.live = true;
  sample.counts = newest.counts;
  if (!newest.state) return sample;
  sample.valid = true;
  sample.pose = newest.state->state.pose;
  sample.arrivedNs = newest.state->arrivedNs;
  return sample;
}

}  // namespace eye
