#include "gpu/time_slices.h"

#include <sched.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdint>
#include <utility>

namespace eye {
namespace {

// sched_setattr(2): glibc 2.36 has neither the call nor its struct.
struct SchedulingAttributes {
  uint32_t size = sizeof(SchedulingAttributes), policy = SCHED_OTHER;
  uint64_t flags = 0;
  int32_t nice = 0;
  uint32_t priority = 0;
  uint64_t runtimeNs = 0, deadlineNs = 0, periodNs = 0;
};
constexpr long kThisThread = 0, kNoFlags = 0;

// Of the calling thread. A time-critical one keeps what it was given.
bool change(auto&& to) {
  SchedulingAttributes now;
  if (syscall(SYS_sched_getattr, kThisThread, &now, sizeof now, kNoFlags) != 0) return false;
  if (now.policy != SCHED_OTHER && now.policy != SCHED_BATCH) return false;
  return to(now) && syscall(SYS_sched_setattr, kThisThread, &now, kNoFlags) == 0;
}

bool changePolicy(uint32_t from, uint32_t to) {
  return change([&](SchedulingAttributes& now) { return std::exchange(now.policy, to) == from; });
}

}  // namespace

void askForSlices(std::chrono::microseconds slice) {
  change([&](SchedulingAttributes& now) {
    now.runtimeNs = static_cast<uint64_t>(std::chrono::nanoseconds(slice).count());
    return true;
  });
}

PatientThreads::PatientThreads() : isSet_(changePolicy(SCHED_OTHER, SCHED_BATCH)) {}

PatientThreads::~PatientThreads() {
  if (isSet_) changePolicy(SCHED_BATCH, SCHED_OTHER);
}

}  // namespace eye
