// Lines and letters over a picture, through cairo. One thread at a time.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "base/error.h"
#include "pano/panorama.h"

namespace eye {

enum class TextWeight { regular, bold };

struct Ink {
  glm::dvec3 colour{0};
  double opacity = 1;
};

class Canvas {
 public:
  // Draws on `rgba`, which must outlive it; alpha stays. An error where the picture is too large for cairo.
  static Result<Canvas> over(std::vector<uint8_t>& rgba, const PanoramaFrame& frame);
  ~Canvas();
  Canvas(Canvas&&) noexcept;
  Canvas& operator=(Canvas&&) noexcept;

  double textWidthPx(const std::string& text, double sizePx, TextWeight weight) const;
  // Baseline from `foot`, upwards at `slopeRad`. With a halo, so that it is read on any ground.
  void text(const std::string& text, glm::dvec2 foot, double sizePx, TextWeight weight, const Ink& ink,
            double slopeRad = 0);
  void line(glm::dvec2 from, glm::dvec2 to, double widthPx, const Ink& ink);
  void rectangle(glm::dvec2 corner, glm::dvec2 sizePx, const Ink& ink);
  // Hands the picture back into `rgba`.
  void finish();

 private:
  struct Impl;
  explicit Canvas(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace eye
