// How the system shares the cores among threads of which there are more than cores.
#pragma once

#include <chrono>

namespace eye {

// The calling thread, and every thread that it starts from now on, is to run for `slice` at a time when others wait for
// its core; zero: the system's own choice. Where the system does not hear of slices (Linux before 6.12) nothing
// changes.
void askForSlices(std::chrono::microseconds slice);

// Threads that the calling one starts in this one's lifetime do not take its core when it gives them work
// (SCHED_BATCH): it goes on to give others theirs. They have their share of the cores all the same.
class PatientThreads {
 public:
  PatientThreads();
  ~PatientThreads();
  PatientThreads(const PatientThreads&) = delete;
  PatientThreads& operator=(const PatientThreads&) = delete;

 private:
  bool isSet_ = false;
};

}  // namespace eye
