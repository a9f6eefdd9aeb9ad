#include "control/membership.h"

#include <algorithm>
#include <cmath>

namespace eye {

double membershipAt(const Membership& membership, double x) {
  if (std::isnan(x)) return x;
  const std::vector<double>& at = membership.at;
  const std::vector<double>& value = membership.value;
  if (x <= at.front()) return value.front();
  if (x >= at.back()) return value.back();
  const size_t next =
      std::min(static_cast<size_t>(std::upper_bound(at.begin(), at.end(), x) - at.begin()), at.size() - 1);
  const size_t last = next - 1;
  return value[last] + (value[next] - value[last]) * (x - at[last]) / (at[next] - at[last]);
}

}  // namespace eye
