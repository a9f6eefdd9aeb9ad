#include "paging/interval.h"

#include <algorithm>
#include <cmath>

namespace eye {
namespace {

constexpr double kShortestS = 0.1, kLongestS = 2;
constexpr double kStandingMS = 0.1;

}  // namespace

double PagingRates::transferBytesS() const {
  return readBytesS > 0 && decodeBytesS > 0 ? 1 / (1 / readBytesS + 1 / decodeBytesS) : 0;
}

Interval chooseInterval(double speedMS, double finestWidthM, const PagingRates& rates, uint64_t roomBytes) {
  const double crossingS = speedMS > kStandingMS && finestWidthM > 0 ? finestWidthM / speedMS : kLongestS;
  const double fillingS = rates.fillingBytesS > 0 ? static_cast<double>(roomBytes) / rates.fillingBytesS : kLongestS;
  const double transferBytesS = rates.transferBytesS();
  return {std::clamp(std::min(crossingS, fillingS), kShortestS, kLongestS),
          transferBytesS <= 0 || rates.demandBytesS < transferBytesS};
}

}  // namespace eye
