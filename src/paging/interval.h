// Equal intervals (paper 000, equations 9 to 11): how long the pager works off one plan before it makes the next.
#pragma once

#include <cstdint>

namespace eye {

// Measured by the pager, running means.
struct PagingRates {
  double readBytesS = 0;     // of the file, while reading
  double decodeBytesS = 0;   // of the file, while decoding
  double demandBytesS = 0;   // of the file, that plans ask for in a second of flight
  double fillingBytesS = 0;  // the same when decoded: what it takes up in memory
  // What reading and decoding one after the other bring, bytes of the file; 0: not known yet.
  double transferBytesS() const;
};

struct Interval {
  double lengthS;
  bool keepsUp;  // equation (11): demand below transfer. Otherwise the least urgent stays coarse
};

// The shortest time in which the viewpoint crosses a chunk of the finest level at hand, (10) v t > l_min: before, a
// plan would say the same again. Not so long that what it asks for exceeds the room in memory, (9) D(t) < D_limit.
// Within 0.1 to 2 s, so that a turn or a stop is answered soon and standing still costs nothing. Where (9) and (10)
// contradict each other, memory wins.
Interval chooseInterval(double speedMS, double finestWidthM, const PagingRates& rates, uint64_t roomBytes);

}  // namespace eye
