// How the system shares the cores among threads of which there are more than cores.
#pragma once

#include <chrono>

namespace eye {

// The calling thread, and every thread that it starts from now on, is to run for `slice` at a time when others wait for
// its core; zero: the system's own choice. Where the system does not hear of slices (Linux before 6.12) nothing
// changes.
void askForSlices(std::chrono::microseconds slice);

}  // namespace eye
