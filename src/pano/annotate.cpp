#include "pano/annotate.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "pano/canvas.h"
#include "pano/label_layout.h"

namespace eye {
namespace {

// A ridge: the ground behind is farther by this share at least, and in full ink where it is twice as far.
constexpr double kRidgeShare = 0.04;
constexpr double kRidgeInk = 0.55, kSkylineInk = 0.6;
// A kilometre farther counts as much as this many metres lower when names compete for room.
constexpr double kHeightPerKm = 25;

const Ink kDark{{0.07, 0.09, 0.13}, 1};
const Ink kPale{{1, 1, 1}, 1};

// A size at which the letters are read on a screen, and still where the picture is printed a metre wide.
double textSizePx(const PanoramaFrame& frame) {
  return std::clamp(frame.heightPx / 64.0, 9.0, 40.0);
}
double scaleHeightPx(const PanoramaFrame& frame) {
  return 2.4 * textSizePx(frame);
}

void drawScale(Canvas& canvas, const PanoramaFrame& frame) {
  constexpr std::array kPoints{"N", "NE", "E", "SE", "S", "SW", "W", "NW"};
  const double size = textSizePx(frame), height = scaleHeightPx(frame), top = frame.heightPx - height;
  canvas.rectangle({0, top}, {frame.widthPx, height}, {{0.05, 0.08, 0.12}, 0.62});
  const double pxPerDeg = 1 / frame.degPerPx();
  const int every = pxPerDeg * 10 > 5 * size ? 10 : 45;  // degrees between numbers
  for (int deg = 0; deg < 360; ++deg) {
    const bool isNamed = deg % 45 == 0, isNumbered = deg % every == 0;
    const double length = isNamed ? 0.55 : isNumbered ? 0.45 : deg % 5 == 0 ? 0.32 : 0.18;
    if (pxPerDeg < 3 && deg % 5 != 0) continue;
    const double x = deg * pxPerDeg;
    canvas.line({x, top}, {x, top + length * size}, isNamed ? 2 : 1, {kPale.colour, 0.9});
    if (!isNamed && !isNumbered) continue;
    const std::string text = isNamed ? fmt::format("{} {}\u00b0", kPoints[static_cast<size_t>(deg / 45)], deg)
                                     : fmt::format("{}\u00b0", deg);
    const TextWeight weight = isNamed ? TextWeight::bold : TextWeight::regular;
    const double width = canvas.textWidthPx(text, size, weight);
    canvas.text(text, {std::max(x - width / 2, 0.2 * size), top + 1.75 * size}, size, weight, kPale);
  }
}

std::string nameOf(const PanoramaPeak& peak) {
  return peak.name + " ";
}
std::string figuresOf(const PanoramaPeak& peak) {
  return fmt::format("{:.0f} m, {:.1f} km", peak.summit.altM, peak.measuredM / 1000);
}

}  // namespace

void drawRidges(Panorama& panorama) {
  const PanoramaFrame& frame = panorama.frame;
  for (int row = 1; row < frame.heightPx; ++row) {
    for (int column = 0; column < frame.widthPx; ++column) {
      const size_t pixel = frame.at(column, row);
      const double here = panorama.distanceM[pixel], behind = panorama.distanceM[frame.at(column, row - 1)];
      if (std::isnan(here)) continue;
      const double leap = std::isnan(behind) ? 1 : std::log2(std::max(behind / here, 1.0));
      // A plain seen at a grazing angle gets farther row by row: a ridge leaps by more than that.
      const double below = panorama.distanceM[frame.at(column, std::min(row + 1, frame.heightPx - 1))];
      if (leap < kRidgeShare * 1.44 + 2 * std::log2(std::max(here / below, 1.0))) continue;
      const double ink = std::isnan(behind) ? kSkylineInk : kRidgeInk * std::sqrt(std::min(leap, 1.0));
      for (size_t c = 0; c < 3; ++c) {
        const double value = panorama.rgba[pixel * 4 + c];
        panorama.rgba[pixel * 4 + c] = static_cast<uint8_t>(value + ink * (255 * kDark.colour[int(c)] - value));
      }
    }
  }
}

Result<int> annotate(Panorama& panorama, std::span<const PanoramaPeak> peaks, const std::string& title) {
  const PanoramaFrame& frame = panorama.frame;
  Result<Canvas> canvas = Canvas::over(panorama.rgba, frame);
  if (!canvas) return tl::unexpected(canvas.error());
  const double size = textSizePx(frame), small = 0.86 * size;

  std::vector<LabelWish> wishes;
  std::vector<const PanoramaPeak*> visible;
  for (const PanoramaPeak& peak : peaks) {
    if (!peak.visible || peak.y >= frame.heightPx - scaleHeightPx(frame)) continue;
    const double lengthPx = canvas->textWidthPx(nameOf(peak), size, TextWeight::bold) +
                            canvas->textWidthPx(figuresOf(peak), small, TextWeight::regular);
    visible.push_back(&peak);
    wishes.push_back({peak.x, peak.y, lengthPx, peak.summit.altM - kHeightPerKm * peak.trueM / 1000});
  }
  const double titleWidthPx = canvas->textWidthPx(title, size, TextWeight::bold);
  const std::array taken{glm::dvec4(0, 0, titleWidthPx + 2 * size, 2.2 * size)};
  const std::vector<int> skyline = skylineRows(panorama);
  const std::vector<PlacedLabel> labels = placeLabels({frame.widthPx, frame.heightPx, size, skyline, taken}, wishes);
  for (const PlacedLabel& label : labels) {
    const LabelWish& wish = wishes[label.wish];
    canvas->line({wish.x, wish.y}, {wish.x, label.foot.y}, 1, {kDark.colour, 0.55});
  }
  for (const PlacedLabel& label : labels) {
    const PanoramaPeak& peak = *visible[label.wish];
    canvas->text(nameOf(peak), label.foot, size, TextWeight::bold, kDark, label.slopeRad);
    const double after = canvas->textWidthPx(nameOf(peak), size, TextWeight::bold);
    const glm::dvec2 along(std::cos(label.slopeRad), -std::sin(label.slopeRad));
    canvas->text(figuresOf(peak), label.foot + along * after, small, TextWeight::regular, kDark, label.slopeRad);
  }
  drawScale(*canvas, frame);
  canvas->text(title, {size, 1.5 * size}, size, TextWeight::bold, kPale);
  canvas->finish();
  return static_cast<int>(labels.size());
}

}  // namespace eye
