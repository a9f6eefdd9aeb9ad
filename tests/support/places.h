// Where tests find things. The paths stand in one source alone, so that all others compile to the same wherever the
// tree lies, and a compiler cache serves every clone.
#pragma once

#include <string>

namespace eye::test {

extern const std::string kTestData;   // real elevation, tracks and captures, which are not part of the repository
extern const std::string kBinDir;     // the programs
extern const std::string kSourceDir;  // the repository
extern const std::string kTestFiles;  // what tests bake and write

}  // namespace eye::test
