// Less detail where the GPU's budget is too small for what is seen, more when it suffices again. Owner thread: render.
#pragma once

#include "paging/residency.h"

namespace eye {

// A selection that wants more than fits would refine what came first and leave the rest at whatever happens to be
// there. A coarser tolerance takes detail from everywhere alike, the farthest and smallest first.
class Coarsening {
 public:
  double factor() const { return factor_; }
  // After each exchange, `stepS` seconds after the last. `isStarved`: something seen found no room. `isMoving`: the
  // view is another one all the time, so that what did not fit may fit now.
  void steer(double stepS, bool isStarved, bool isMoving, const Residency& residency);

 private:
  double factor_ = 1;
  double starvedAt_ = 1;  // the last factor that was too fine
};

}  // namespace eye
