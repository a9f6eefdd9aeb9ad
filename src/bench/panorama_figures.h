// How well distances are told: the error metrics of paper 002. Pure.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "bench/panorama_published.h"

namespace eye {

struct DistancePair {
  double toldM = 0, trueM = 0;
};

struct DistanceFigures {
  std::array<double, kErrorSteps> within{};  // share of the pairs whose error is below 5, 10, ... 40 % of the truth
  double mape = 0, r2 = 0, rmseM = 0, relativeSquaredError = 0;
  size_t peaks = 0;
};
// All NaN but the count where there are none.
DistanceFigures distanceFigures(std::span<const DistancePair> pairs);

// Distances corrected by true = b told + c, least squares. Each seventh of the pairs is corrected by what the other six
// give, so that none is judged by a line that it had a part in. (The paper takes the best of the seven lines.) Nothing
// where there are fewer than two pairs a seventh.
inline constexpr size_t kFolds = 7, kLeastForRegression = 2 * kFolds;
std::optional<std::vector<DistancePair>> withRegression(std::span<const DistancePair> pairs);

}  // namespace eye
