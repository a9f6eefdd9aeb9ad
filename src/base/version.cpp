#include "base/version.h"

namespace eye {

std::string sourceCommit() {
  return EYE_COMMIT;
}

std::string versionLine(const std::string& program) {
  return program + " " EYE_VERSION " (commit " EYE_COMMIT ")";
}

}  // namespace eye
