// How far a picture is from a better one. Pure.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace eye {

// The mean of pictures of one size; red, green and blue of each pixel behind one another, 0 to 255.
class MeanPicture {
 public:
  void add(std::span<const uint8_t> rgba);
  std::vector<float> rgb() const;  // empty without pictures
  int count() const { return count_; }

 private:
  std::vector<uint32_t> sums_;
  int count_ = 0;
};

std::vector<float> rgbOf(std::span<const uint8_t> rgba);

// 10 log10(255^2 / mean squared difference); infinite where the two are the same.
double psnrDb(std::span<const float> rgb, std::span<const float> reference);

// Mean structural similarity of the brightness (Rec. 601), Wang et al. 2004: Gaussian windows of 11 pixels, sigma 1.5,
// those that lie in the picture whole, K1 = 0.01, K2 = 0.03. 1: the same.
double ssim(std::span<const float> rgb, std::span<const float> reference, int widthPx, int heightPx);

}  // namespace eye
