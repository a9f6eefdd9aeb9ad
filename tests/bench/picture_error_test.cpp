// Errors of pictures against values worked out by hand.
#include <cmath>

#include <catch2/catch.hpp>

#include "bench/picture_error.h"

namespace eye {
namespace {

constexpr int kWidth = 32, kHeight = 24;

template <class Value>
std::vector<float> grey(Value&& value) {
  std::vector<float> rgb;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) rgb.insert(rgb.end(), 3, static_cast<float>(value(x, y)));
  return rgb;
}

}  // namespace

TEST_CASE("PSNR: one step everywhere is 48.13 dB, ten 28.13, none infinitely much") {
  const auto a = grey([](int x, int y) { return (7 * x + 3 * y) % 200; });
  const auto off = [&](float by) {
    std::vector<float> b = a;
    for (float& value : b) value += by;
    return b;
  };
  CHECK(psnrDb(off(1), a) == Approx(48.1308).margin(1e-3));
  CHECK(psnrDb(off(-10), a) == Approx(28.1308).margin(1e-3));
  CHECK(std::isinf(psnrDb(a, a)));
  std::vector<float> one = a;
  one[100] += 100;  // a single value: 10 log10(255^2 * 2304 / 10^4)
  CHECK(psnrDb(one, a) == Approx(10 * std::log10(65025.0 * kWidth * kHeight * 3 / 1e4)).margin(1e-3));
}

TEST_CASE("SSIM: flat greys by their means, a negative by its contrast") {
  const auto flat = [](int value) { return grey([value](int, int) { return value; }); };
  CHECK(ssim(flat(100), flat(100), kWidth, kHeight) == Approx(1));
  CHECK(ssim(flat(100), flat(150), kWidth, kHeight) == Approx(30006.5025 / 32506.5025).margin(1e-4));
  // A chequerboard of 128 +- 50: covariance -2500, both variances 2500.
  const auto board = [](int contrast) {
    return grey([contrast](int x, int y) { return 128 + ((x + y) % 2 == 0 ? contrast : -contrast); });
  };
  CHECK(ssim(board(50), board(50), kWidth, kHeight) == Approx(1));
  CHECK(ssim(board(-50), board(50), kWidth, kHeight) == Approx((-5000 + 58.5225) / (5000 + 58.5225)).margin(1e-3));
}

TEST_CASE("the mean of pictures is theirs, alpha left out") {
  MeanPicture mean;
  mean.add(std::vector<uint8_t>{10, 20, 30, 255, 0, 0, 0, 255});
  mean.add(std::vector<uint8_t>{20, 20, 31, 0, 255, 1, 0, 0});
  CHECK(mean.rgb() == std::vector<float>{15, 20, 30.5f, 127.5f, 0.5f, 0});
  CHECK(mean.count() == 2);
}

}  // namespace eye
