#include "base/error.h"

#include <cstdio>
#include <cstdlib>

namespace eye {

void checkFailed(const char* expression, const char* file, int line) {
  std::fprintf(stderr, "%s:%d: invariant broken: %s\n", file, line, expression);
  std::abort();
}

}  // namespace eye
