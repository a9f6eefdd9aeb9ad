// Text is as long where it is drawn as where room was made for it, at every slope.
#include "pano/canvas.h"

#include <cmath>

#include <catch2/catch.hpp>

namespace eye {
namespace {

// How far from the foot the farthest pixel lies that the text changed, along its slope.
double drawnLengthPx(const std::string& text, double sizePx, TextWeight weight, double slopeRad, double& saidPx) {
  const PanoramaFrame frame{500, 500};
  constexpr uint8_t kGrey = 128;
  std::vector<uint8_t> rgba(frame.pixels() * 4, kGrey);
  auto canvas = Canvas::over(rgba, frame);
  REQUIRE(canvas);
  const glm::dvec2 foot(20, 480);
  saidPx = canvas->textWidthPx(text, sizePx, weight);
  canvas->text(text, foot, sizePx, weight, {{0, 0, 0}, 1}, slopeRad);
  canvas->finish();
  double farthestPx = 0;
  for (int row = 0; row < frame.heightPx; ++row)
    for (int column = 0; column < frame.widthPx; ++column)
      if (rgba[frame.at(column, row) * 4] < kGrey / 2)
        farthestPx = std::max(farthestPx,
                              std::cos(slopeRad) * (column + 0.5 - foot.x) - std::sin(slopeRad) * (row + 0.5 - foot.y));
  return farthestPx;
}

}  // namespace

TEST_CASE("Canvas: text is drawn as long as it is said to be, level and at a slant") {
  const std::string text = "Lomnicky stit, AIGUILLE DU MIDI 3842 m";
  for (const TextWeight weight : {TextWeight::regular, TextWeight::bold}) {
    for (const double sizePx : {9.0, 10.67, 12.3, 14.0}) {
      for (const double slopeDeg : {0.0, 55.0, 90.0}) {
        double saidPx = 0;
        const double drawnPx = drawnLengthPx(text, sizePx, weight, radFromDeg(slopeDeg), saidPx);
        INFO(sizePx << " px at " << slopeDeg << " degrees");
        CHECK(drawnPx < saidPx + 1);
        CHECK(drawnPx > saidPx - 3);  // the last digit's own margin
      }
    }
  }
}

}  // namespace eye
