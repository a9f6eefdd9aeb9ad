// CPU time in milliseconds: what work costs, however busy the machine is.
#pragma once

namespace eye {

double processCpuMs();  // of every thread since the program's start
double threadCpuMs();   // of the calling thread

}  // namespace eye
