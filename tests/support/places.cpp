#include "support/places.h"

namespace eye::test {

const std::string kTestData = EYE_TEST_DATA, kBinDir = EYE_BIN_DIR, kSourceDir = EYE_SOURCE_DIR,
                  kTestFiles = EYE_TEST_FILES;

}  // namespace eye::test
