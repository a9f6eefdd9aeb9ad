// CPU time in milliseconds: what work costs, however busy the machine is.
#pragma once

#include <pthread.h>

namespace eye {

double processCpuMs();                 // of every thread since the program's start
double threadCpuMs();                  // of the calling thread
double threadCpuMs(pthread_t thread);  // of one that has not been joined

}  // namespace eye
