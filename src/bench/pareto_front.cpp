#include "bench/pareto_front.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace eye {
namespace {

// Between the two nearest of sorted values.
double quantile(const std::vector<double>& sorted, double share) {
  const double at = share * static_cast<double>(sorted.size() - 1);
  const auto low = static_cast<size_t>(at);
  const size_t high = std::min(low + 1, sorted.size() - 1);
  return std::lerp(sorted[low], sorted[high], at - static_cast<double>(low));
}

}  // namespace

bool beats(const ParetoPoint& a, const ParetoPoint& b) {
  EYE_CHECK(a.errors.size() == b.errors.size());
  for (size_t i = 0; i < a.errors.size(); ++i)
    if (a.errors[i] > b.errors[i]) return false;
  return a.cost + a.spread < (1 - kLeastGain) * (b.cost - b.spread);
}

std::vector<bool> onFront(std::span<const ParetoPoint> points) {
  std::vector<bool> on;
  for (const ParetoPoint& point : points)
    on.push_back(std::ranges::none_of(points, [&](const ParetoPoint& other) { return beats(other, point); }));
  return on;
}

SpreadMedian spreadMedian(std::vector<double> values) {
  EYE_CHECK(!values.empty());
  std::ranges::sort(values);
  const double between = quantile(values, 0.75) - quantile(values, 0.25);
  return {quantile(values, 0.5), 1.57 * between / std::sqrt(static_cast<double>(values.size()))};
}

}  // namespace eye
