#include "gpu/time_slices.h"

#include <sched.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdint>

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

}  // namespace

void askForSlices(std::chrono::microseconds slice) {
  SchedulingAttributes now;
  if (syscall(SYS_sched_getattr, kThisThread, &now, sizeof now, kNoFlags) != 0) return;
  if (now.policy != SCHED_OTHER && now.policy != SCHED_BATCH) return;  // a time-critical thread keeps what it was given
  now.runtimeNs = static_cast<uint64_t>(std::chrono::nanoseconds(slice).count());
  syscall(SYS_sched_setattr, kThisThread, &now, kNoFlags);
}

}  // namespace eye
