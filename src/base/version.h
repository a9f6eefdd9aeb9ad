// Which Eyepoint this is.
#pragma once

#include <string>

namespace eye {

// Of the sources, when they were configured; "unknown" outside a git checkout.
std::string sourceCommit();
// What --version says: "eyepoint 0.1.0 (commit 0123456789ab)".
std::string versionLine(const std::string& program);

}  // namespace eye
