#include "bench/panorama_figures.h"

#include <cmath>
#include <limits>
#include <vector>

namespace eye {
namespace {

struct Line {
  double slope = 1, offsetM = 0;
};

template <class Wanted>
Line fit(std::span<const DistancePair> pairs, const Wanted& isWanted) {
  double count = 0, meanTold = 0, meanTrue = 0;
  for (size_t i = 0; i < pairs.size(); ++i)
    if (isWanted(i)) count += 1, meanTold += pairs[i].toldM, meanTrue += pairs[i].trueM;
  meanTold /= count, meanTrue /= count;
  double squares = 0, products = 0;
  for (size_t i = 0; i < pairs.size(); ++i) {
    if (!isWanted(i)) continue;
    squares += (pairs[i].toldM - meanTold) * (pairs[i].toldM - meanTold);
    products += (pairs[i].toldM - meanTold) * (pairs[i].trueM - meanTrue);
  }
  const double slope = squares > 0 ? products / squares : 1;
  return {slope, meanTrue - slope * meanTold};
}

}  // namespace

DistanceFigures distanceFigures(std::span<const DistancePair> pairs) {
  DistanceFigures figures;
  figures.peaks = pairs.size();
  const double count = static_cast<double>(pairs.size());
  double meanTrue = 0, shares = 0, squares = 0, spread = 0;
  for (const DistancePair& pair : pairs) meanTrue += pair.trueM / count;
  for (const DistancePair& pair : pairs) {
    const double errorM = pair.toldM - pair.trueM, share = std::abs(errorM) / pair.trueM;
    shares += share, squares += errorM * errorM, spread += (pair.trueM - meanTrue) * (pair.trueM - meanTrue);
    for (size_t i = 0; i < kErrorSteps; ++i) figures.within[i] += share < 0.05 * static_cast<double>(i + 1) ? 1 : 0;
  }
  for (double& within : figures.within) within /= count;
  figures.mape = shares / count;
  figures.rmseM = std::sqrt(squares / count);
  figures.relativeSquaredError = squares / spread;
  figures.r2 = 1 - figures.relativeSquaredError;
  return figures;
}

std::optional<std::vector<DistancePair>> withRegression(std::span<const DistancePair> pairs) {
  if (pairs.size() < kLeastForRegression) return std::nullopt;
  std::vector<DistancePair> corrected(pairs.begin(), pairs.end());
  for (size_t fold = 0; fold < kFolds; ++fold) {
    const Line line = fit(pairs, [&](size_t i) { return i % kFolds != fold; });
    for (size_t i = fold; i < pairs.size(); i += kFolds)
      corrected[i].toldM = line.slope * pairs[i].toldM + line.offsetM;
  }
  return corrected;
}

}  // namespace eye
