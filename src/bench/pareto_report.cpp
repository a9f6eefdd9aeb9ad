#include "bench/pareto_report.h"

#include <algorithm>

#include <fmt/format.h>

#include "app/option_values.h"

namespace eye {
namespace {

bool isDefault(const ParetoResult& result) {
  return result.setting == ParetoSetting{};
}

const ParetoResult& defaultOf(const std::vector<ParetoResult>& results, glm::ivec2 sizePx) {
  const ParetoSetting wanted{.sizePx = sizePx};
  const auto found = std::ranges::find(results, wanted, &ParetoResult::setting);
  EYE_CHECK(found != results.end());
  return *found;
}

// Its CPU time on the scale on which the default of its size was measured.
double comparableMs(const std::vector<ParetoResult>& results, const ParetoResult& result) {
  return result.cpuAgainstDefault.median * defaultOf(results, result.setting.sizePx).cpuMs;
}

nlohmann::ordered_json rowOf(const ParetoResult& r, bool isOnFront) {
  return {{"sse", r.setting.ssePx},
          {"culling", nameOf(r.setting.culling)},
          {"depth_map", r.setting.depthMapName()},
          {"sampler", r.samplerName},
          {"samples", r.setting.samples},
          {"size", r.setting.sizeName()},
          {"cpu_ms", r.cpuMs},
          {"cpu_spread_ms", r.cpuSpreadMs},
          {"wall_ms", r.wallMs},
          {"gpu_ms", r.gpuMs},
          {"cpu_against_default", r.cpuAgainstDefault.median},
          {"cpu_against_default_spread", r.cpuAgainstDefault.spread},
          {"wall_against_default", r.wallAgainstDefault.median},
          {"triangles", r.triangles},
          {"explained", r.explained},
          {"distance_median", r.distanceMedian},
          {"distance_p99", r.distanceP99},
          {"skyline_px", r.skylinePx},
          {"psnr_db", r.psnrDb},
          {"ssim", r.ssim},
          {"missing_chunks", r.missing},
          {"on_front", isOnFront},
          {"is_default", isDefault(r)}};
}

ReportTable tableOf(const std::vector<ParetoResult>& results, const std::vector<bool>& front) {
  ReportTable table{.caption = "Time and error of each setting",
                    .groups = {{"", 3}, {"CPU", 2}, {"", 2}, {"distances", 4}, {"colours", 2}, {"", 1}},
                    .columns = {"setting", "size", "triangles", "ms", "of default", "wall ms", "on the front",
                                "explained", "median error", "p99 error", "skyline px", "PSNR dB", "SSIM", "missing"},
                    .isPrinted = true};
  for (size_t i = 0; i < results.size(); ++i) {
    const ParetoResult& r = results[i];
    table.rows.push_back(
        {r.setting.name(), r.setting.sizeName(), fmt::format("{:.0f}", r.triangles), fmt::format("{:.2f}", r.cpuMs),
         fmt::format("{:.2f} +-{:.2f}", r.cpuAgainstDefault.median, r.cpuAgainstDefault.spread),
         fmt::format("{:.2f}", r.wallMs), front[i] ? "yes" : "", fmt::format("{:.3f} %", 100 * r.explained),
         fmt::format("{:.1e}", r.distanceMedian), fmt::format("{:.1e}", r.distanceP99),
         fmt::format("{:.2f}", r.skylinePx), fmt::format("{:.2f}", r.psnrDb), fmt::format("{:.4f}", r.ssim),
         fmt::format("{}", r.missing)});
  }
  return table;
}

// The front of two dimensions: from the cheapest on, each better than all cheaper ones.
Series frontLine(std::vector<std::pair<double, double>> points, bool moreIsBetter) {
  std::ranges::sort(points);
  Series line{.name = "front"};
  for (const auto& [ms, error] : points) {
    if (!line.y.empty() && (moreIsBetter ? error <= line.y.back() : error >= line.y.back())) continue;
    line.x.push_back(ms);
    line.y.push_back(error);
  }
  return line;
}

ReportPlot plotOf(const std::vector<ParetoResult>& results, const std::string& size, const std::string& title,
                  const std::string& yLabel, double ParetoResult::*error, bool moreIsBetter) {
  ReportPlot plot{.title = title + ", " + size,
                  .xLabel = "CPU ms a frame",
                  .yLabel = yLabel,
                  .isLogarithmic = !moreIsBetter,
                  .isLogarithmicX = true,
                  .isFromZero = false};
  std::vector<std::pair<double, double>> points;
  Series standard{.name = "default", .areDots = true, .dotPx = 7};
  std::vector<Series> kinds;
  for (const ParetoResult& r : results) {
    if (r.setting.sizeName() != size) continue;
    const double ms = comparableMs(results, r);
    points.emplace_back(ms, r.*error);
    const ParetoSetting& s = r.setting;
    const std::string kind = s.samples > 1                        ? "4 samples"
                             : s.sampler != TextureFilter::device ? "sampler"
                             : s.depthMapPx                       ? "depth map"
                                                                  : "culling " + nameOf(s.culling);
    auto series = std::ranges::find(kinds, kind, &Series::name);
    if (series == kinds.end()) series = kinds.insert(kinds.end(), Series{.name = kind, .areDots = true, .dotPx = 4});
    Series& of = s == ParetoSetting{.sizePx = s.sizePx} ? standard : *series;
    of.x.push_back(ms);
    of.y.push_back(r.*error);
    of.labels.push_back(fmt::format("{}: {:.2f} ms, {:.4g}", s.name(), ms, r.*error));
  }
  plot.series.push_back(frontLine(std::move(points), moreIsBetter));
  plot.series.push_back(std::move(standard));
  plot.series.insert(plot.series.end(), kinds.begin(), kinds.end());
  return plot;
}

}  // namespace

std::vector<bool> paretoFront(const std::vector<ParetoResult>& results) {
  std::vector<bool> front(results.size());
  for (size_t i = 0; i < results.size(); ++i) {
    // Of one size: a pixel of another is another angle.
    std::vector<ParetoPoint> points;
    size_t own = 0;
    for (size_t k = 0; k < results.size(); ++k) {
      const ParetoResult& r = results[k];
      if (r.setting.sizePx != results[i].setting.sizePx) continue;
      if (k == i) own = points.size();
      points.push_back(
          {r.cpuAgainstDefault.median, r.cpuAgainstDefault.spread, {1 - r.explained, r.distanceP99, -r.psnrDb}});
    }
    front[i] = onFront(points)[own];
  }
  return front;
}

void addPareto(const std::vector<ParetoResult>& results, const std::string& truth, SuiteReport& report) {
  const std::vector<bool> front = paretoFront(results);
  bool isOn = false;
  int missing = 0;
  std::vector<std::string> sizes;
  for (size_t i = 0; i < results.size(); ++i) {
    report.rows.push_back(rowOf(results[i], front[i]));
    if (isDefault(results[i])) isOn = front[i];
    missing += results[i].missing;
    const std::string size = results[i].setting.sizeName();
    if (std::ranges::find(sizes, size) == sizes.end()) sizes.push_back(size);
  }
  report.summary["default_on_front"] = isOn;
  report.summary["truth"] = truth;
  report.targets.push_back({"The default lies on the front of time and error", isOn ? "yes" : "no", isOn});
  for (const std::string& size : sizes) {
    report.plots.push_back(plotOf(results, size, "Distances: relative error of the worst hundredth of the pixels",
                                  "99th percentile", &ParetoResult::distanceP99, false));
    report.plots.push_back(plotOf(results, size, "Colours: against 64 samples a pixel of the finest data", "PSNR, dB",
                                  &ParetoResult::psnrDb, true));
  }
  report.tables.push_back(tableOf(results, front));
  report.notes.emplace_back(
      "Truth of distances: " + truth +
      ". explained: the drawn distance lies within the true ones of the pixel and its eight neighbours, "
      "widened by 0.1 %. skyline: rows between the drawn and the true one, mean of the columns.");
  report.notes.emplace_back(
      "Truth of colours: the mean of pictures whose rays are spread over the pixel, a tolerance of 0.125 px, "
      "trilinear.");
  report.notes.emplace_back(
      "Settings of one block are drawn in turn, each block with the default of its size; of default: the median of the "
      "ratios of frames drawn behind one another, and by how much it may be off (1.57 distances of the quartiles over "
      "the root of the count). The plots put every setting on the default's scale by it.");
  report.notes.emplace_back(
      "On the front: no other setting of that size explains as much, has a 99th percentile as small and a PSNR as "
      "high, "
      "and takes less time by more than the spread of both. The line in the plots is the front of that plot's two axes "
      "by medians alone.");
  if (missing > 0)
    report.notes.push_back(
        fmt::format("{} chunks were not resident: those settings are coarser than they say.", missing));
}

}  // namespace eye
