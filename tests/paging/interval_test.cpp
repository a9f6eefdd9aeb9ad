#include "paging/interval.h"

#include <catch2/catch.hpp>

#include "paging/pace_meter.h"

namespace eye {

TEST_CASE("the interval is the time over a finest chunk, within memory and the bounds") {
  const PagingRates slow{.readBytesS = 60e6, .decodeBytesS = 30e6, .demandBytesS = 1e5, .fillingBytesS = 1e6};
  CHECK(chooseInterval(300, 150, slow, 1 << 30).lengthS == Approx(0.5));  // (10)
  CHECK(chooseInterval(300, 10, slow, 1 << 30).lengthS == Approx(0.1));
  CHECK(chooseInterval(10, 5000, slow, 1 << 30).lengthS == Approx(2));
  CHECK(chooseInterval(0, 150, slow, 1 << 30).lengthS == Approx(2));
  CHECK(chooseInterval(300, 0, slow, 1 << 30).lengthS == Approx(2));
  CHECK(chooseInterval(300, 600, slow, 800'000).lengthS == Approx(0.8));  // (9) wins over (10)
  CHECK(chooseInterval(300, 600, slow, 0).lengthS == Approx(0.1));
}

TEST_CASE("demand beyond what reading and decoding bring does not keep up") {
  PagingRates rates{.readBytesS = 60e6, .decodeBytesS = 30e6, .demandBytesS = 19e6};
  CHECK(rates.transferBytesS() == Approx(20e6));  // one after the other
  CHECK(chooseInterval(300, 600, rates, 1 << 30).keepsUp);
  rates.demandBytesS = 21e6;
  CHECK_FALSE(chooseInterval(300, 600, rates, 1 << 30).keepsUp);
  CHECK(chooseInterval(300, 600, {}, 1 << 30).keepsUp);  // nothing is known yet
}

TEST_CASE("rates are those of what was loaded and asked for") {
  PaceMeter meter;
  for (int i = 0; i < 200; ++i)
    meter.loaded({.readS = 0.001, .decodeS = 0.004, .fileBytes = 100'000, .decodedBytes = 400'000});
  CHECK(meter.rates().readBytesS == Approx(100e6));
  CHECK(meter.rates().decodeBytesS == Approx(25e6));
  for (int frame = 0; frame <= 60 * 20; ++frame) meter.asked(frame % 6 == 0 ? 1 : 0, frame / 60.0);  // 10 a second
  CHECK(meter.rates().demandBytesS == Approx(1e6).epsilon(0.05));
  CHECK(meter.rates().fillingBytesS == Approx(4e6).epsilon(0.05));
  for (int frame = 0; frame <= 60 * 20; ++frame) meter.asked(0, 20 + frame / 60.0);
  CHECK(meter.rates().demandBytesS < 1e4);
}

}  // namespace eye
