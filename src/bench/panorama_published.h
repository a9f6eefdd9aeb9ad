// What Demenkova and Tverdokhlebov (paper 002, Tables 1 to 3) report of 119 peaks, against U. Deuschle's panoramas.
#pragma once

#include <array>
#include <string_view>

namespace eye {

// Errors below 5, 10, ... 40 %.
inline constexpr size_t kErrorSteps = 8;

struct PublishedShares {
  std::string_view camera;
  std::array<double, kErrorSteps> within;
  int peaks;
};
inline constexpr std::array<PublishedShares, 4> kPublishedShares{
    {{"higher", {0.519, 0.649, 0.740, 0.779, 0.831, 0.857, 0.935, 1}, 77},
     {"lower", {0.309, 0.476, 0.500, 0.595, 0.619, 0.714, 0.976, 1}, 42},
     {"all", {0.445, 0.588, 0.655, 0.714, 0.756, 0.807, 0.950, 1}, 119},
     {"lower_regression", {0.119, 0.405, 0.667, 0.976, 1, 1, 1, 1}, 42}}};

struct PublishedMetrics {
  double r2, rmseM, relativeSquaredError, mape;
};
inline constexpr PublishedMetrics kPublishedPlain{0.831952360592, 6360.7378968, 0.168047639408, 0.166815799976};
inline constexpr PublishedMetrics kPublishedRegression{0.912449916357, 4591.1298369, 0.087550083643, 0.119236588191};

}  // namespace eye
