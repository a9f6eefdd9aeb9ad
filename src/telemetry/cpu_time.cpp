#include "telemetry/cpu_time.h"

#include <time.h>

namespace eye {
namespace {

double clockMs(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) * 1e3 + static_cast<double>(time.tv_nsec) * 1e-6;
}

}  // namespace

double processCpuMs() {
  return clockMs(CLOCK_PROCESS_CPUTIME_ID);
}

double threadCpuMs() {
  return clockMs(CLOCK_THREAD_CPUTIME_ID);
}

double threadCpuMs(pthread_t thread) {
  clockid_t clock = 0;
  return pthread_getcpuclockid(thread, &clock) == 0 ? clockMs(clock) : 0;
}

}  // namespace eye
