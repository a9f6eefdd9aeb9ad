// What an occluded triangle costs when it is drawn, learnt from frames with and without the pass.
#pragma once

#include <limits>

#include "control/selector_rules.h"

namespace eye {

class TriangleCost {
 public:
  explicit TriangleCost(const AdaptiveRules& rules) : rules_(rules) {}

  // Neighbouring frames: drawing took `moreMs` longer without the pass, which had removed so many triangles.
  void observe(double moreMs, double triangles);
  // An occluded triangle costs no more than the mean of all that are drawn: `meanMs` bounds what is assumed.
  void bound(double meanMs) { boundMs_ = meanMs; }
  double ms() const;
  // The same drawn to zero: what measurements alone have shown.
  double provenMs() const;

 private:
  AdaptiveRules rules_;
  double boundMs_ = std::numeric_limits<double>::infinity();
  // Least squares through the origin, in ms and triangles, drawn to the assumed cost.
  double moreTimesTriangles_ = 0, trianglesSquared_ = 0;
};

}  // namespace eye
