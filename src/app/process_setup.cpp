#include "app/process_setup.h"

#include <malloc.h>

#include <csignal>

namespace eye {

void setUpProcess() {
  // A software rasteriser frees and takes megabytes in every frame: keep them instead of giving them back to the
  // system.
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  mallopt(M_TOP_PAD, 64 << 20);
  std::signal(SIGPIPE, SIG_IGN);  // a pipe whose reader dies is an error of its write
}

}  // namespace eye
