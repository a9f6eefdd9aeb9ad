// Which settings are worth choosing: those that none beats in time and in every error. Pure.
#pragma once

#include <span>
#include <vector>

namespace eye {

struct ParetoPoint {
  double cost = 0;             // a median
  double spread = 0;           // how far from it the true median may lie
  std::vector<double> errors;  // the same ones of every point; less is better
};

// Less than this share of the cost is not worth a choice: the selector may spend as much on finding out what to choose,
// and where it has, a fixed choice of the same is that much cheaper.
inline constexpr double kLeastGain = 0.02;
// None of its errors is greater, and it costs less by more than that and the spread of the two.
bool beats(const ParetoPoint& a, const ParetoPoint& b);

// By point: no other beats it.
std::vector<bool> onFront(std::span<const ParetoPoint> points);

// The median and how far it may be off: 1.57 times the distance between the quartiles over the root of the count, the
// notch of a box plot (McGill, Tukey and Larsen 1978), about 95 %.
struct SpreadMedian {
  double median = 0, spread = 0;
};
SpreadMedian spreadMedian(std::vector<double> values);  // not empty

}  // namespace eye
