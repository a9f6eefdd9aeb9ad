// A Chrome/Perfetto trace of every thread: RAII scopes that cost one relaxed atomic load while no trace is asked for.
#pragma once

#include <cstdint>
#include <string>

#include "base/error.h"

namespace eye {

// Monotonic, nanoseconds since an arbitrary origin: the clock of every time stamp in the program.
int64_t monotonicNs();

// Starts recording; scopes that begin after this call are kept in memory until writeTrace. Call once, any thread.
void startTrace();
// Names the calling thread in the trace and to the system (`top -H`); at most 15 characters reach the system.
void nameThread(const std::string& name);
// A finished span on a lane that is not a thread of this program, such as "GPU". Both names are literals. Any thread.
void traceSpan(const char* lane, const char* name, int64_t beginNs, int64_t endNs);
// Writes the JSON that chrome://tracing and Perfetto open: what has ended so far; recording goes on.
Result<void> writeTrace(const std::string& path);

// `name` must outlive the program (a literal).
class TraceScope {
 public:
  explicit TraceScope(const char* name);
  ~TraceScope();
  TraceScope(const TraceScope&) = delete;
  TraceScope& operator=(const TraceScope&) = delete;

 private:
  const char* name_;
  int64_t beginNs_;
};

}  // namespace eye
