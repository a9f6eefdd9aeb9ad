// A panorama: all round the eye, every column one azimuth and every row one elevation angle (equirectangular).
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "geo/frames.h"

namespace eye {

// Pixels are square: 360 / widthPx degrees each way. Column 0 begins at north and columns run eastwards; the middle
// between the middle rows is level. A point of the picture is (x, y) in pixels; pixel (column, row) has its centre at
// (column + 0.5, row + 0.5).
struct PanoramaFrame {
  int widthPx = 0, heightPx = 0;

  double degPerPx() const { return 360.0 / widthPx; }
  double azimuthDeg(double x) const { return x * degPerPx(); }
  double elevationDeg(double y) const { return (heightPx / 2.0 - y) * degPerPx(); }
  double xOf(double azimuthDeg) const {
    const double turn = azimuthDeg / 360;
    return (turn - std::floor(turn)) * widthPx;
  }
  double yOf(double elevationDeg) const { return heightPx / 2.0 - elevationDeg / degPerPx(); }
  size_t at(int column, int row) const {
    return static_cast<size_t>(row) * static_cast<size_t>(widthPx) + static_cast<size_t>(column);
  }
  size_t pixels() const { return static_cast<size_t>(widthPx) * static_cast<size_t>(heightPx); }
};

// The frame whose height is nearest to the vertical angle.
inline PanoramaFrame panoramaFrame(int widthPx, double verticalFovDeg) {
  return {widthPx, std::max(1, static_cast<int>(std::lround(verticalFovDeg / 360 * widthPx)))};
}

struct Panorama {
  PanoramaFrame frame;
  Geodetic eye;
  std::vector<uint8_t> rgba;
  std::vector<float> distanceM;  // range along the ray; NaN: sky
  std::vector<float> planarM{};  // as paper 002 tells it (see planar_depth.h), beside the range; empty unless asked for

  // What is written and named: the paper's distances where they were asked for.
  std::span<const float> told() const { return planarM.empty() ? distanceM : planarM; }
};

// The highest row with terrain in every column, heightPx where there is none.
std::vector<int> skylineRows(const Panorama& panorama);

}  // namespace eye
