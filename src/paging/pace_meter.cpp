#include "paging/pace_meter.h"

#include <algorithm>

namespace eye {
namespace {

constexpr double kFade = 0.95;  // a group: the mean is over some 20
constexpr double kWindowS = 1;  // of demand
constexpr double kWindowsFade = 0.6;

}  // namespace

void PaceMeter::loaded(const LoadCost& cost) {
  groups_ = groups_ * kFade + 1;
  bytes_ = bytes_ * kFade + static_cast<double>(cost.fileBytes);
  readS_ = readS_ * kFade + cost.readS;
  decodeS_ = decodeS_ * kFade + cost.decodeS;
  if (readS_ > 0) rates_.readBytesS = bytes_ / readS_;
  if (decodeS_ > 0) rates_.decodeBytesS = bytes_ / decodeS_;
}

void PaceMeter::asked(uint64_t groups, double nowS) {
  inWindow_ += groups;
  const double spanS = nowS - sinceS_;
  if (spanS < kWindowS) return;
  const double bytesAGroup = groups_ > 0 ? bytes_ / groups_ : 0;
  const double nowBytesS = static_cast<double>(inWindow_) * bytesAGroup / spanS;
  rates_.demandBytesS = kWindowsFade * rates_.demandBytesS + (1 - kWindowsFade) * nowBytesS;
  sinceS_ = nowS;
  inWindow_ = 0;
}

}  // namespace eye
