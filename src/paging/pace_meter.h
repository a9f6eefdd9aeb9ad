// Rates for the choice of the interval, measured as the flight goes. Owner thread: render.
#pragma once

#include "paging/chunk_loader.h"
#include "paging/interval.h"

namespace eye {

class PaceMeter {
 public:
  void loaded(const LoadCost& cost);
  // Groups asked for that were not asked for before, until `nowS`.
  void asked(uint64_t groups, double nowS);
  const PagingRates& rates() const { return rates_; }

 private:
  PagingRates rates_;
  // Sums that fade by a share with each group.
  double groups_ = 0, bytes_ = 0, decodedBytes_ = 0, readS_ = 0, decodeS_ = 0;
  double sinceS_ = 0;  // of the window in which groups are being counted
  uint64_t inWindow_ = 0;
};

}  // namespace eye
