// What every program that draws sets once, before its first thread.
#pragma once

namespace eye {

void setUpProcess();

}  // namespace eye
