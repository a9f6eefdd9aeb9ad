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
  decodedBytes_ = decodedBytes_ * kFade + static_cast<double>(cost.decodedBytes);
  readS_ = readS_ * kFade + cost.readS;
  decodeS_ = decodeS_ * kFade + cost.decodeS;
  if (readS_ > 0) rates_.readBytesS = bytes_ / readS_;
  if (decodeS_ > 0) rates_.decodeBytesS = bytes_ / decodeS_;
}

void PaceMeter::asked(uint64_t groups, double nowS) {
  inWindow_ += groups;
  const double spanS = nowS - sinceS_;
  if (spanS < kWindowS) return;
  const double groupsS = static_cast<double>(inWindow_) / spanS;
  const auto follow = [&](double& rate, double ofAllGroups) {
    const double nowBytesS = groups_ > 0 ? groupsS * ofAllGroups / groups_ : 0;
    rate = kWindowsFade * rate + (1 - kWindowsFade) * nowBytesS;
  };
  follow(rates_.demandBytesS, bytes_);
  follow(rates_.fillingBytesS, decodedBytes_);
  sinceS_ = nowS;
  inWindow_ = 0;
}

}  // namespace eye
