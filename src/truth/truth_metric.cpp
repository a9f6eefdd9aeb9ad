#include "truth/truth_metric.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace eye::truth {
namespace {

constexpr double kWidening = 1e-3;  // of the neighbourhood's distances

// The true distances around a pixel, itself among them.
struct Neighbourhood {
  double nearestM = std::numeric_limits<double>::infinity();
  double farthestM = 0;
  bool sky = false, terrain = false, unknown = false;
};

Neighbourhood around(const TruthImage& truth, int row, int column) {
  Neighbourhood n;
  for (int r = row - 1; r <= row + 1; ++r) {
    for (int c = column - 1; c <= column + 1; ++c) {
      const Hit& hit = truth.at(r, c);
      if (hit.kind == HitKind::unknown) n.unknown = true;
      if (hit.kind == HitKind::sky) n.sky = true;
      if (hit.kind != HitKind::terrain) continue;
      n.terrain = true;
      n.nearestM = std::min(n.nearestM, hit.distanceM);
      n.farthestM = std::max(n.farthestM, hit.distanceM);
    }
  }
  return n;
}

PixelVerdict judge(const Neighbourhood& n, float renderedM) {
  if (n.unknown) return PixelVerdict::notAssessed;
  if (std::isnan(renderedM)) return n.sky ? PixelVerdict::explained : PixelVerdict::skyBelowSkyline;
  if (!n.terrain) return PixelVerdict::terrainAboveSkyline;
  if (renderedM < n.nearestM * (1 - kWidening)) return PixelVerdict::tooNear;
  // Sky is infinitely far: beside it a crest may be off by its pixel, and what shows behind it is as far as it happens
  // to be.
  if (!n.sky && renderedM > n.farthestM * (1 + kWidening)) return PixelVerdict::tooFar;
  return PixelVerdict::explained;
}

double quantile(std::vector<double>& values, double share) {
  if (values.empty()) return 0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

Comparison compare(const TruthImage& truth, std::span<const float> renderedM) {
  Comparison result;
  result.verdicts.reserve(renderedM.size());
  std::vector<double> errors;
  errors.reserve(renderedM.size());
  for (size_t i = 0; i < renderedM.size(); ++i) {
    const int row = static_cast<int>(i) / truth.widthPx, column = static_cast<int>(i) % truth.widthPx;
    const PixelVerdict verdict = judge(around(truth, row, column), renderedM[i]);
    result.verdicts.push_back(verdict);
    const bool assessed = verdict != PixelVerdict::notAssessed;
    result.assessed += assessed;
    result.notAssessed += !assessed;
    result.explained += verdict == PixelVerdict::explained;
    result.skyBelowSkyline += verdict == PixelVerdict::skyBelowSkyline;
    result.terrainAboveSkyline += verdict == PixelVerdict::terrainAboveSkyline;
    const Hit& hit = truth.at(row, column);
    if (assessed && hit.kind == HitKind::terrain && !std::isnan(renderedM[i])) {
      errors.push_back(std::abs(renderedM[i] - hit.distanceM) / hit.distanceM);
    }
  }
  result.medianError = quantile(errors, 0.5);
  result.p99Error = quantile(errors, 0.99);
  return result;
}

std::string summaryLine(const Comparison& c) {
  return fmt::format(
      "explained {:.4f} %, error median {:.2e} p99 {:.2e}, sky below the skyline {}, terrain above it {}, "
      "not assessed {} of {}",
      100 * c.explainedShare(), c.medianError, c.p99Error, c.skyBelowSkyline, c.terrainAboveSkyline, c.notAssessed,
      c.verdicts.size());
}

std::vector<uint8_t> errorPicture(const Comparison& comparison) {
  static constexpr std::array<std::array<uint8_t, 4>, 6> kColours{{{128, 128, 128, 255},
                                                                   {255, 0, 0, 255},
                                                                   {0, 0, 255, 255},
                                                                   {255, 0, 255, 255},
                                                                   {255, 160, 0, 255},
                                                                   {0, 0, 0, 255}}};
  std::vector<uint8_t> rgba;
  rgba.reserve(comparison.verdicts.size() * 4);
  for (const PixelVerdict verdict : comparison.verdicts) {
    const auto& colour = kColours[static_cast<size_t>(verdict)];
    rgba.insert(rgba.end(), colour.begin(), colour.end());
  }
  return rgba;
}

}  // namespace eye::truth
