// A surface of posts at whole multiples of a spacing all over the globe, bilinear between, for the mesher's tests.
#pragma once

#include <cmath>
#include <functional>
#include <unordered_map>
#include <utility>

#include "bake/elevation.h"
#include "geo/frames.h"

namespace eye::test {

class PostSurface final : public ElevationSurface {
 public:
  // `postsPerDeg` a whole number, 0 for no posts at all: then `height` is called at the places themselves.
  PostSurface(int postsPerDeg, std::function<double(double latDeg, double lonDeg)> height)
      : postsPerDeg_(postsPerDeg), height_(std::move(height)) {}

  double heightM(double latDeg, double lonDeg) const override {
    if (postsPerDeg_ == 0) return height_(latDeg, lonDeg);
    const double n = postsPerDeg_;
    const double row = std::min(std::floor(latDeg * n), 90 * n - 1), column = std::floor(lonDeg * n);
    const double t = latDeg * n - row, s = lonDeg * n - column;
    const double south = (1 - s) * post(row, column) + s * post(row, column + 1);
    if (t == 0.0) return south;
    return (1 - t) * south + t * ((1 - s) * post(row + 1, column) + s * post(row + 1, column + 1));
  }
  PostLines postLines(const TileBounds& r) const override {
    PostLines lines;
    if (postsPerDeg_ == 0) return lines;
    fill(r.southDeg, r.northDeg, lines.latDeg);
    fill(r.westDeg, r.eastDeg, lines.lonDeg);
    return lines;
  }
  double finestSpacingDeg(const TileBounds&) const override { return postsPerDeg_ == 0 ? 0.0 : 1.0 / postsPerDeg_; }
  TileBounds dataBounds() const override { return {-90, 90, -180, 180}; }

 private:
  double post(double row, double column) const {
    double lon = column / postsPerDeg_;
    if (lon >= 180.0) lon -= 360.0;
    if (lon < -180.0) lon += 360.0;
    const auto [entry, isNew] = posts_.try_emplace({row, lon});
    if (isNew) entry->second = height_(row / postsPerDeg_, lon);
    return entry->second;
  }
  void fill(double low, double high, std::vector<double>& lines) const {
    const double n = postsPerDeg_;
    for (double i = std::floor(low * n); i <= std::ceil(high * n); i += 1.0) {
      if (i / n > low && i / n < high) lines.push_back(i / n);
    }
  }

  struct PostHash {
    size_t operator()(const std::pair<double, double>& p) const {
      return std::hash<double>()(p.first) * 31 + std::hash<double>()(p.second);
    }
  };

  int postsPerDeg_;
  std::function<double(double, double)> height_;
  // Heights may be costly; one thread at a time.
  mutable std::unordered_map<std::pair<double, double>, double, PostHash> posts_;
};

// Rough at every scale and whole on the globe: the same all round a pole and on both sides of the date line.
inline double roughGlobeM(double latDeg, double lonDeg) {
  const Vec3d p = upAt(latDeg, lonDeg);
  double sum = 0, amplitude = 900, frequency = 9;
  for (int octave = 0; octave < 9; ++octave) {
    sum += amplitude * std::sin(frequency * p.x + 1.3 * octave) * std::sin(frequency * p.y + 0.7) *
           std::cos(frequency * p.z - octave);
    amplitude *= 0.55;
    frequency *= 2.3;
  }
  return sum;
}

}  // namespace eye::test
