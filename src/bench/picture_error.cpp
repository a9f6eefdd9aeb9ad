#include "bench/picture_error.h"

#include <array>
#include <cmath>
#include <limits>

#include "base/error.h"

namespace eye {
namespace {

constexpr int kRadius = 5;  // of the windows of 11 pixels
constexpr double kSigma = 1.5;
constexpr float kC1 = (0.01f * 255) * (0.01f * 255), kC2 = (0.03f * 255) * (0.03f * 255);

std::array<float, 2 * kRadius + 1> gaussian() {
  std::array<float, 2 * kRadius + 1> weights;
  float sum = 0;
  for (int i = -kRadius; i <= kRadius; ++i) {
    const auto weight = static_cast<float>(std::exp(-i * i / (2 * kSigma * kSigma)));
    weights[static_cast<size_t>(i + kRadius)] = weight;
    sum += weight;
  }
  for (float& weight : weights) weight /= sum;
  return weights;
}

// Weighted means of the windows that lie in the picture whole: rows, then columns.
std::vector<float> blurred(const std::vector<float>& from, int widthPx, int heightPx) {
  static const auto kWeights = gaussian();
  const int width = widthPx - 2 * kRadius, height = heightPx - 2 * kRadius;
  const auto at = [](int y, int x, int stride) {
    return static_cast<size_t>(y) * static_cast<size_t>(stride) + static_cast<size_t>(x);
  };
  std::vector<float> rows(at(heightPx, 0, width)), both(at(height, 0, width));
  for (int y = 0; y < heightPx; ++y)
    for (int x = 0; x < width; ++x)
      for (size_t k = 0; k < kWeights.size(); ++k) rows[at(y, x, width)] += kWeights[k] * from[at(y, x, widthPx) + k];
  for (int y = 0; y < height; ++y)
    for (size_t k = 0; k < kWeights.size(); ++k)
      for (int x = 0; x < width; ++x)
        both[at(y, x, width)] += kWeights[k] * rows[at(y + static_cast<int>(k), x, width)];
  return both;
}

std::vector<float> brightness(std::span<const float> rgb) {
  std::vector<float> y(rgb.size() / 3);
  for (size_t i = 0; i < y.size(); ++i) y[i] = 0.299f * rgb[3 * i] + 0.587f * rgb[3 * i + 1] + 0.114f * rgb[3 * i + 2];
  return y;
}

std::vector<float> product(const std::vector<float>& a, const std::vector<float>& b) {
  std::vector<float> result(a.size());
  for (size_t i = 0; i < a.size(); ++i) result[i] = a[i] * b[i];
  return result;
}

}  // namespace

void MeanPicture::add(std::span<const uint8_t> rgba) {
  if (sums_.empty()) sums_.resize(rgba.size() / 4 * 3);
  EYE_CHECK(sums_.size() == rgba.size() / 4 * 3);
  for (size_t i = 0; i < rgba.size() / 4; ++i)
    for (size_t k = 0; k < 3; ++k) sums_[3 * i + k] += rgba[4 * i + k];
  ++count_;
}

std::vector<float> MeanPicture::rgb() const {
  std::vector<float> mean(sums_.size());
  for (size_t i = 0; i < mean.size(); ++i) mean[i] = static_cast<float>(sums_[i]) / static_cast<float>(count_);
  return mean;
}

std::vector<float> rgbOf(std::span<const uint8_t> rgba) {
  MeanPicture one;
  one.add(rgba);
  return one.rgb();
}

double psnrDb(std::span<const float> rgb, std::span<const float> reference) {
  EYE_CHECK(rgb.size() == reference.size() && !rgb.empty());
  double squares = 0;
  for (size_t i = 0; i < rgb.size(); ++i) {
    const double difference = double(rgb[i]) - double(reference[i]);
    squares += difference * difference;
  }
  if (squares == 0) return std::numeric_limits<double>::infinity();
  return 10 * std::log10(255.0 * 255.0 * static_cast<double>(rgb.size()) / squares);
}

double ssim(std::span<const float> rgb, std::span<const float> reference, int widthPx, int heightPx) {
  EYE_CHECK(rgb.size() == reference.size() && widthPx > 2 * kRadius && heightPx > 2 * kRadius);
  const std::vector<float> a = brightness(rgb), b = brightness(reference);
  const auto mean = [&](const std::vector<float>& of) { return blurred(of, widthPx, heightPx); };
  const std::vector<float> meanA = mean(a), meanB = mean(b);
  const std::vector<float> aa = mean(product(a, a)), bb = mean(product(b, b)), ab = mean(product(a, b));
  double sum = 0;
  for (size_t i = 0; i < meanA.size(); ++i) {
    const float muAB = meanA[i] * meanB[i], muAA = meanA[i] * meanA[i], muBB = meanB[i] * meanB[i];
    sum += double((2 * muAB + kC1) * (2 * (ab[i] - muAB) + kC2) /
                  ((muAA + muBB + kC1) * (aa[i] + bb[i] - muAA - muBB + kC2)));
  }
  return sum / static_cast<double>(meanA.size());
}

}  // namespace eye
