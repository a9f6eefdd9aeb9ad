// What the flight suite stands beside: Hao et al. (paper 000), Table I, and errors of predictions from a reference
// implementation on the same kinds of path.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string_view>

namespace eye {

struct PublishedFlight {
  int task = 0;  // 1: high resolution; 2 and 3: tracks in mountains, 32 m
  int rateHz = 0;
  std::string_view unoptimized, optimized;  // the paper's words
};

inline constexpr std::array<PublishedFlight, 9> kPublishedFlights{{
    {1, 15, "Smooth", "Smooth"},
    {1, 25, "Relatively smooth", "Smooth"},
    {1, 100, "Frames drop out", "Relatively smooth"},
    {2, 15, "Smooth", "Smooth"},
    {2, 25, "fluency", "Smooth"},
    {2, 100, "Relatively smooth", "Smooth"},
    {3, 15, "Smooth", "Smooth"},
    {3, 25, "Smooth", "Smooth"},
    {3, 100, "Relatively smooth", "Smooth"},
}};

constexpr std::optional<PublishedFlight> publishedFlight(int task, int rateHz) {
  for (const PublishedFlight& row : kPublishedFlights)
    if (row.task == task && row.rateHz == rateHz) return row;
  return std::nullopt;
}

// Errors in space, metres, at 300 m/s and 60 Hz with a noise of 2 m an axis; NaN: not known.
struct ReferencePrediction {
  std::string_view manoeuvre, method;  // as in PredictionRow
  double horizonS = 0, rmsM = 0, p95M = std::numeric_limits<double>::quiet_NaN();
};

inline constexpr std::array<ReferencePrediction, 24> kReferencePredictions{{
    {"standard-rate turns", "hold", 0.5, 150, 153},
    {"standard-rate turns", "hold", 1, 300},
    {"standard-rate turns", "hold", 2, 600},
    {"standard-rate turns", "hold", 5, 1498},
    {"standard-rate turns", "difference", 0.5, 8.1, 13},
    {"standard-rate turns", "difference", 1, 14.3, 24},
    {"standard-rate turns", "difference", 2, 32, 58},
    {"standard-rate turns", "difference", 5, 141, 255},
    {"standard-rate turns", "kalman6", 0.5, 3.7, 6.5},
    {"standard-rate turns", "kalman6", 1, 8.7, 15.5},
    {"standard-rate turns", "kalman6", 2, 26, 45},
    {"standard-rate turns", "kalman6", 5, 135, 228},
    {"standard-rate turns", "kalman9", 0.5, 2.4, 3.9},
    {"standard-rate turns", "kalman9", 1, 4.7, 7.8},
    {"standard-rate turns", "kalman9", 2, 12, 21},
    {"standard-rate turns", "kalman9", 5, 63, 127},
    {"60-degree bank reversals", "kalman6", 1, 13.8, 17.6},
    {"60-degree bank reversals", "kalman6", 5, 201, 249},
    {"60-degree bank reversals", "kalman9", 1, 8.0, 17.7},
    {"60-degree bank reversals", "kalman9", 5, 179, 370},
    {"straight", "kalman6", 1, 1.3},
    {"straight", "kalman6", 5, 4.2},
    {"straight", "kalman9", 1, 4.5},
    {"straight", "kalman9", 5, 47},
}};

constexpr std::optional<ReferencePrediction> referencePrediction(std::string_view manoeuvre, std::string_view method,
                                                                 double horizonS) {
  for (const ReferencePrediction& row : kReferencePredictions)
    if (row.manoeuvre == manoeuvre && row.method == method && row.horizonS == horizonS) return row;
  return std::nullopt;
}

}  // namespace eye
