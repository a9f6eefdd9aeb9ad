// A whole run: frames at their pace until something ends it, then the outputs.
#pragma once

#include "app/options.h"
#include "base/error.h"

namespace eye {

Result<void> printDevices();
// `startedNs`: monotonicNs() when the program began, for startup_ms.
Result<void> run(const Options& options, int64_t startedNs);

}  // namespace eye
