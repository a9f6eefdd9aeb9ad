#include "link/host_state.h"

namespace eye {

void Mailbox::put(const HostState& state) {
  const std::lock_guard lock(mutex_);
  latest_.state = state;
}

void Mailbox::count(const HostCounts& counts) {
  const std::lock_guard lock(mutex_);
  latest_.counts = counts;
}

Mailbox::Snapshot Mailbox::take() const {
  const std::lock_guard lock(mutex_);
  return latest_;
}

}  // namespace eye
