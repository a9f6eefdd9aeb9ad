#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "bench/report.h"

namespace eye {
namespace {

constexpr double kWidth = 960, kHeight = 330;
constexpr double kLetter = 6.6;  // of 12 px type, on average
constexpr double kLeft = 64, kRight = 14, kTop = 34, kBottom = 46;
// Told apart on light and dark ground, and by the colour-blind (Okabe and Ito, a little darker).
constexpr std::array kColours{"#0072b2", "#d55e00", "#009e73", "#c4639a", "#b58900", "#3aa0d8", "#7f7f7f", "#8a63d2"};

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  void add(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  bool isEmpty() const { return !(low <= high); }
};

// From values to pixels along one axis, and where its lines are.
struct Axis {
  double low = 0, high = 1;
  bool isLogarithmic = false;
  std::vector<double> ticks;

  double share(double value) const {
    if (isLogarithmic) return std::log(value / low) / std::log(high / low);
    return (value - low) / (high - low);
  }
};

Axis linearAxis(Range range, bool fromZero) {
  if (range.isEmpty()) range = {0, 1};
  if (fromZero) range.add(0);
  if (range.high - range.low <= 0) range.high = range.low + 1;
  const double rough = (range.high - range.low) / 6, power = std::pow(10, std::floor(std::log10(rough)));
  double step = 10 * power;
  for (const double factor : {5.0, 2.0, 1.0})
    if (factor * power >= rough) step = factor * power;
  Axis axis{std::floor(range.low / step) * step, std::ceil(range.high / step) * step, false, {}};
  for (int i = 0; axis.low + i * step <= axis.high + step / 2; ++i) axis.ticks.push_back(axis.low + i * step);
  return axis;
}

Axis logarithmicAxis(const Range& range) {
  if (range.isEmpty() || range.low <= 0) return linearAxis({1, 10}, false);
  Axis axis{std::pow(10, std::floor(std::log10(range.low))), std::pow(10, std::ceil(std::log10(range.high))), true, {}};
  if (axis.high <= axis.low) axis.high = 10 * axis.low;
  for (double tick = axis.low; tick <= axis.high * 1.001; tick *= 10) axis.ticks.push_back(tick);
  return axis;
}

// From one of 1, 2, 5, 10 ... to another.
Axis finelyLogarithmicAxis(const Range& range) {
  if (range.isEmpty() || range.low <= 0) return linearAxis({1, 10}, false);
  std::vector<double> steps;
  for (double decade = std::pow(10, std::floor(std::log10(range.low))); decade <= 10 * range.high; decade *= 10)
    for (const double factor : {1.0, 2.0, 5.0}) steps.push_back(factor * decade);
  const auto end = std::ranges::find_if(steps, [&](double step) { return step >= range.high * 1.001; });
  auto begin = end - 1;
  while (begin != steps.begin() && *begin > range.low) --begin;
  return {*begin, *end, true, {begin, end + 1}};
}

double xPx(double share) {
  return kLeft + share * (kWidth - kLeft - kRight);
}
double yPx(double share) {
  return kHeight - kBottom - share * (kHeight - kTop - kBottom);
}

std::string text(double x, double y, const char* anchor, const std::string& words, const char* more = "") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>", x, y, anchor, more,
                     escapeHtml(words));
}

std::string frame(const ReportPlot& plot, const Axis& y) {
  std::string svg;
  for (const double tick : y.ticks) {
    const double at = yPx(y.share(tick));
    svg += fmt::format("<line class=\"axis\" x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\"/>", kLeft, kWidth - kRight,
                       at, at);
    svg += text(kLeft - 6, at + 4, "end", fmt::format("{:g}", std::abs(tick) < 1e-12 ? 0 : tick));
  }
  svg += text(xPx(0.5), kHeight - 6, "middle", plot.xLabel);
  svg +=
      text(14, yPx(0.5), "middle", plot.yLabel, fmt::format(" transform=\"rotate(-90 14 {:.1f})\"", yPx(0.5)).c_str());
  double x = kLeft, line = 8;
  for (size_t i = 0; i < plot.series.size(); ++i) {
    const double wide = 36 + kLetter * static_cast<double>(plot.series[i].name.size());
    if (x > kLeft && x + wide > kWidth) {  // into the plot's own room, rather than out of the picture
      x = kLeft;
      line += 17;
    }
    svg += fmt::format("<rect x=\"{:.1f}\" y=\"{}\" width=\"12\" height=\"12\" rx=\"2\" fill=\"{}\"/>", x, line,
                       kColours[i % kColours.size()]);
    svg += text(x + 17, line + 10, "start", plot.series[i].name, " class=\"legend\"");
    x += wide;
  }
  return svg;
}

std::string bars(const ReportPlot& plot, const Axis& y) {
  std::string svg;
  const double slot = 1.0 / static_cast<double>(plot.categories.size());
  const double width = 0.8 * slot / static_cast<double>(plot.series.size());
  for (size_t c = 0; c < plot.categories.size(); ++c) {
    const double left = static_cast<double>(c) * slot;
    svg += text(xPx(left + slot / 2), kHeight - kBottom + 17, "middle", plot.categories[c]);
    for (size_t s = 0; s < plot.series.size(); ++s) {
      if (c >= plot.series[s].y.size() || !std::isfinite(plot.series[s].y[c])) continue;
      const double value = plot.series[s].y[c];
      const double from = yPx(y.isLogarithmic ? 0 : y.share(0)), to = yPx(y.share(value));
      svg += fmt::format(
          "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"><title>{}, {}: {:.4g}</title>"
          "</rect>",
          xPx(left + 0.1 * slot + static_cast<double>(s) * width), std::min(from, to),
          width * (kWidth - kLeft - kRight) * 0.94, std::abs(from - to), kColours[s % kColours.size()],
          escapeHtml(plot.series[s].name), escapeHtml(plot.categories[c]), value);
    }
  }
  return svg;
}

std::string lines(const ReportPlot& plot, const Axis& y) {
  Range range;
  for (const Series& series : plot.series)
    for (const double value : series.x) range.add(value);
  const Axis x = plot.isLogarithmicX ? finelyLogarithmicAxis(range) : linearAxis(range, false);
  std::string svg;
  for (const double tick : x.ticks)
    svg += text(xPx(x.share(tick)), kHeight - kBottom + 17, "middle", fmt::format("{:g}", tick));
  for (size_t s = 0; s < plot.series.size(); ++s) {
    const Series& series = plot.series[s];
    std::string points;
    for (size_t i = 0; i < std::min(series.x.size(), series.y.size()); ++i) {
      if (!std::isfinite(series.x[i]) || !std::isfinite(series.y[i]) || (y.isLogarithmic && series.y[i] <= 0)) continue;
      const double px = xPx(x.share(series.x[i])), py = yPx(y.share(series.y[i]));
      if (series.areDots)
        svg +=
            fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:g}\" fill=\"{}\" fill-opacity=\"0.8\">{}</circle>",
                        px, py, series.dotPx, kColours[s % kColours.size()],
                        i < series.labels.size() ? "<title>" + escapeHtml(series.labels[i]) + "</title>" : "");
      else
        points += fmt::format("{:.1f},{:.1f} ", px, py);
    }
    if (series.areDots) continue;
    svg += fmt::format(
        "<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\" stroke-linejoin=\"round\" points=\"{}\">"
        "<title>{}</title></polyline>",
        kColours[s % kColours.size()], points, escapeHtml(series.name));
  }
  return svg;
}

}  // namespace

namespace {

std::string drawing(const ReportPlot& plot) {
  Range range;
  for (const Series& series : plot.series)
    for (const double value : series.y)
      if (!plot.isLogarithmic || value > 0) range.add(value);
  const bool isBars = !plot.categories.empty();
  const Axis y = plot.isLogarithmic ? logarithmicAxis(range) : linearAxis(range, isBars || plot.isFromZero);
  return frame(plot, y) + (isBars ? bars(plot, y) : lines(plot, y));
}

// The page's colours, for a picture that has no page; readers of SVG ask for light or dark as browsers do.
constexpr const char* kPictureStyle =
    "svg{color-scheme:light dark;--ink:#1c2733;--soft:#5b6b7b;--line:#d8dfe6;--card:#fff}"
    "@media(prefers-color-scheme:dark){svg{--ink:#e4e9ee;--soft:#9aa8b5;--line:#33404c;--card:#1c242c}"
    "polyline,circle,rect:not(.card){filter:brightness(1.35)}}"
    "text{fill:var(--soft);font:12px system-ui,sans-serif}.axis{stroke:var(--line)}.legend{fill:var(--ink)}"
    ".title{fill:var(--ink);font:600 15px system-ui,sans-serif}.card{fill:var(--card)}";
constexpr double kTitle = 34, kMargin = 8;

}  // namespace

std::string plotSvg(const ReportPlot& plot) {
  return fmt::format("<svg viewBox=\"0 0 {} {}\" width=\"{}\" role=\"img\" aria-label=\"{}\">{}</svg>", kWidth, kHeight,
                     kWidth, escapeHtml(plot.title), drawing(plot));
}

std::string plotPicture(const ReportPlot& plot) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\">"
      "<style>{2}</style><rect class=\"card\" width=\"{0}\" height=\"{1}\" rx=\"8\"/>{3}"
      "<g transform=\"translate(0 {4})\">{5}</g></svg>\n",
      kWidth + kMargin, kHeight + kTitle + kMargin, kPictureStyle,
      text(kLeft, 24, "start", plot.title, " class=\"title\""), kTitle, drawing(plot));
}

}  // namespace eye
