// The metric itself: a perfect map passes, and each kind of fault is counted as what it is.
#include "truth/truth_metric.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

namespace eye::truth {
namespace {

constexpr int kWidth = 40, kHeight = 30;

TruthImage ridgeBeforeSky() {
  const HeightGrid grid({49, 20, 1.0 / 1200, 1201, 1201},
                        [](double lat, double) { return lat > 49.55 && lat < 49.56 ? 1500.0 : 200.0; });
  return castImage(grid, {{49.5, 20.5, 1200}, 0, 0, 0}, 60, kWidth, kHeight);
}

std::vector<float> perfectMap(const TruthImage& truth) {
  std::vector<float> map;
  for (int r = 0; r < kHeight; ++r) {
    for (int c = 0; c < kWidth; ++c) {
      const Hit& hit = truth.at(r, c);
      map.push_back(hit.kind == HitKind::sky ? std::numeric_limits<float>::quiet_NaN()
                                             : static_cast<float>(hit.distanceM));
    }
  }
  return map;
}

size_t at(int row, int column) {
  return static_cast<size_t>(row * kWidth + column);
}

}  // namespace

TEST_CASE("metric: a perfect map is wholly explained") {
  const TruthImage truth = ridgeBeforeSky();
  const Comparison result = compare(truth, perfectMap(truth));
  CHECK(result.notAssessed == 0);
  CHECK(result.explainedShare() == 1);
  CHECK(result.p99Error < 1e-6);
  CHECK(truth.at(0, 20).kind == HitKind::sky);
  CHECK(truth.at(kHeight - 1, 20).kind == HitKind::terrain);
}

TEST_CASE("metric: near, far, holes and phantoms are told apart") {
  const TruthImage truth = ridgeBeforeSky();
  std::vector<float> map = perfectMap(truth);
  map[at(kHeight - 2, 3)] *= 0.7f;
  map[at(kHeight - 2, 8)] *= 1.5f;
  map[at(kHeight - 2, 13)] = std::numeric_limits<float>::quiet_NaN();
  map[at(1, 5)] = 5000;
  const Comparison result = compare(truth, map);
  CHECK(result.verdicts[at(kHeight - 2, 3)] == PixelVerdict::tooNear);
  CHECK(result.verdicts[at(kHeight - 2, 8)] == PixelVerdict::tooFar);
  CHECK(result.verdicts[at(kHeight - 2, 13)] == PixelVerdict::skyBelowSkyline);
  CHECK(result.verdicts[at(1, 5)] == PixelVerdict::terrainAboveSkyline);
  CHECK(result.explained == kWidth * kHeight - 4);
  CHECK(result.skyBelowSkyline == 1);
  CHECK(result.terrainAboveSkyline == 1);
}

TEST_CASE("metric: a skyline one pixel off is explained, three pixels off is not") {
  const TruthImage truth = ridgeBeforeSky();
  const std::vector<float> map = perfectMap(truth);
  const auto shiftedDown = [&](int rows) {
    std::vector<float> shifted = map;
    for (int r = kHeight - 1; r >= rows; --r) {
      for (int c = 0; c < kWidth; ++c) shifted[at(r, c)] = map[at(r - rows, c)];
    }
    return compare(truth, shifted);
  };
  CHECK(shiftedDown(1).skyBelowSkyline == 0);
  CHECK(shiftedDown(1).explainedShare() == 1);
  CHECK(shiftedDown(3).skyBelowSkyline >= kWidth);
}

TEST_CASE("metric: no pixel beside an unknown truth is judged") {
  TruthImage truth = ridgeBeforeSky();
  const std::vector<float> map = perfectMap(truth);
  truth.hits[static_cast<size_t>((10 + 1) * (kWidth + 2) + 10 + 1)].kind = HitKind::unknown;
  const Comparison result = compare(truth, map);
  CHECK(result.notAssessed == 9);
  CHECK(result.explainedShare() == 1);
}

}  // namespace eye::truth
