// How far a bake is, on stderr.
#pragma once

#include "bake/baker.h"
#include "base/progress_line.h"

namespace eye {

class ProgressPrinter {
 public:
  void show(const BakeProgress& progress);
  void showShare(const char* what, uint64_t done, uint64_t total);

 private:
  ProgressLine line_;
};

}  // namespace eye
