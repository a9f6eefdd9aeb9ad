// How fast this machine is at this minute: fixed work that uses none of what is measured, so that times of another
// machine, or of this one on a busy day, can be compared. Owner thread: render.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "base/error.h"

namespace eye {

// CPU time of fixed work, medians of some runs: less is faster.
struct MachineSpeed {
  double loopMs = 0;               // one thread: arithmetic, branches, reads all over 8 MiB
  std::optional<double> drawMs{};  // the process: one frame of 15,000 triangles; none where a GPU draws

  // One number for both: their geometric mean.
  double referenceMs() const;
};

MachineSpeed meanOf(const MachineSpeed& a, const MachineSpeed& b);

class SpeedReference {
 public:
  // `device`: part of its name, as the suites have it.
  static Result<SpeedReference> create(const std::string& device);
  Result<MachineSpeed> measure();  // takes about a second

  SpeedReference(SpeedReference&&) noexcept;
  SpeedReference& operator=(SpeedReference&&) noexcept;
  ~SpeedReference();

 private:
  struct Frame;
  SpeedReference();
  std::unique_ptr<Frame> frame_;  // null: not a device that draws on the CPU
};

}  // namespace eye
