#include "bench/compare.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>

#include <fmt/format.h>

namespace eye {
namespace {

// A figure of 0 has no share to be off by.
double offBy(double now, double then) {
  if (now == then) return 0;
  return then == 0 ? HUGE_VAL : now / then - 1;
}

// Baselines keep six digits.
constexpr double kDigits = 1e-5;

Verdict judge(const Figure& then, double now) {
  const double off = offBy(now, then.value);
  if (then.kind != FigureKind::time)
    return std::abs(off) <= std::max(then.band, kDigits) ? Verdict::same : Verdict::off;
  if (off > then.band) return Verdict::slower;
  return off < -then.band ? Verdict::faster : Verdict::same;
}

const char* wordOf(Verdict verdict) {
  switch (verdict) {
    case Verdict::same:
      return "";
    case Verdict::off:
      return "NOT THE SAME";
    case Verdict::slower:
      return "SLOWER";
    case Verdict::faster:
      return "faster";
    case Verdict::missing:
      return "MISSING";
    case Verdict::added:
      return "new";
  }
  return "";
}

bool isFault(const ComparedFigure& compared) {
  return compared.verdict == Verdict::off || compared.verdict == Verdict::slower ||
         compared.verdict == Verdict::missing;
}

// The terrain's folder may be another one.
std::string settingsWithoutFolders(const std::string& settings) {
  const size_t end = std::min(settings.find(','), settings.size()), slash = settings.rfind('/', end);
  return slash == std::string::npos ? settings : settings.substr(slash + 1);
}

}  // namespace

bool Comparison::isSame() const {
  return std::ranges::none_of(figures, isFault);
}

Result<Comparison> compare(const Figures& report, const Figures& baseline) {
  const std::string now = settingsWithoutFolders(report.settings), then = settingsWithoutFolders(baseline.settings);
  if (now != then)
    return fail(ErrorKind::usage, fmt::format("the report was measured with '{}', the baseline with '{}': measure "
                                              "again with the same terrain and the same --quick",
                                              now, then));
  Comparison comparison;
  const auto find = [](const Figures& in, const std::string& name) {
    return std::ranges::find(in.figures, name, &Figure::name);
  };
  for (const Figure& figure : baseline.figures) {
    const auto found = find(report, figure.name);
    if (found == report.figures.end())
      comparison.figures.push_back({figure, NAN, Verdict::missing});
    else
      comparison.figures.push_back({figure, found->value, judge(figure, found->value)});
  }
  for (const Figure& figure : report.figures)
    if (find(baseline, figure.name) == baseline.figures.end())
      comparison.figures.push_back({figure, figure.value, Verdict::added});
  return comparison;
}

std::string comparisonText(const Comparison& comparison) {
  size_t width = std::strlen("what"), same = 0;
  std::vector<const ComparedFigure*> shown;
  for (const ComparedFigure& compared : comparison.figures) {
    if (compared.verdict == Verdict::same && compared.figure.kind != FigureKind::time) {
      ++same;
      continue;
    }
    shown.push_back(&compared);
    width = std::max(width, compared.figure.name.size());
  }
  std::string text =
      fmt::format("{:<{}}  {:>10}  {:>10}  {:>8}  {:>8}\n", "what", width, "baseline", "now", "off by", "band");
  for (const ComparedFigure* compared : shown) {
    const Figure& figure = compared->figure;
    const bool hasBoth = compared->verdict != Verdict::missing && compared->verdict != Verdict::added;
    const std::string band = figure.kind == FigureKind::time ? fmt::format("+{:.0f} %", 100 * figure.band)
                             : figure.band > 0               ? fmt::format("{:.0f} %", 100 * figure.band)
                                                             : "exact";
    const double off = hasBoth ? offBy(compared->now, figure.value) : NAN;
    text += fmt::format("{:<{}}  {:>10}  {:>10}  {:>8}  {:>8}  {}\n", figure.name, width,
                        compared->verdict == Verdict::added ? "" : fmt::format("{:.6g}", figure.value),
                        compared->verdict == Verdict::missing ? "" : fmt::format("{:.6g}", compared->now),
                        std::isfinite(off) ? fmt::format("{:+.1f} %", 100 * off) : "", band, wordOf(compared->verdict));
  }
  text += fmt::format(
      "{} counts are as they were. Times: CPU time in units of the machine's speed, measured beside "
      "them.\n",
      same);
  return text;
}

Result<void> compareFiles(const std::string& reportPath, const std::string& baselinePath, bool update) {
  const Result<Figures> report = readFigures(reportPath);
  if (!report) return tl::unexpected(report.error());
  if (report->figures.empty())
    return fail(ErrorKind::badData, fmt::format("{}: holds no figure to compare: measure a suite first", reportPath));
  if (update) {
    std::ofstream file(baselinePath, std::ios::binary);
    file << baselineJson(*report);
    file.close();
    if (!file) return fail(ErrorKind::io, fmt::format("{}: cannot write: {}", baselinePath, std::strerror(errno)));
    fmt::print("{}: {} figures\n", baselinePath, report->figures.size());
    return {};
  }
  const Result<Figures> baseline = readFigures(baselinePath);
  if (!baseline) return tl::unexpected(baseline.error());
  const Result<Comparison> comparison = compare(*report, *baseline);
  if (!comparison) return tl::unexpected(comparison.error());
  if (report->device != baseline->device)
    fmt::print("The baseline was drawn by {}, this report by {}.\n", baseline->device, report->device);
  fmt::print("{}", comparisonText(*comparison));
  if (comparison->isSame()) return {};
  const auto faults = std::ranges::count_if(comparison->figures, isFault);
  return fail(ErrorKind::badData,
              fmt::format("{}: {} of {} figures are not as in {}, see the table; where that is meant: eyepoint-bench "
                          "compare {} {} --update",
                          reportPath, faults, comparison->figures.size(), baselinePath, reportPath, baselinePath));
}

}  // namespace eye
