#include "bench/culling_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/error.h"
#include "bench/published.h"

namespace eye {
namespace {

constexpr size_t kFrustum = 1, kDynamic = 2;  // of kSchemes
constexpr int kLowFt = 1000;
// What is aimed at: low in the mountains dynamic culling saves so much, and nowhere does it lose more.
constexpr double kSaving = 0.25, kLoss = 0.02;

std::string sizeName(const CullingCell& cell) {
  return fmt::format("{}x{}", cell.sizePx.x, cell.sizePx.y);
}

std::string percent(double share) {
  return fmt::format("{:.1f} %", 100 * share);
}

// "640x480", or all that the views had.
std::string depthMapOf(const SchemeFigures& figures) {
  std::string names;
  for (const auto& [name, share] : figures.depthMaps) names += (names.empty() ? "" : ", ") + name;
  return names;
}

nlohmann::ordered_json rowOf(const CullingCell& cell, size_t scheme) {
  const SchemeFigures& figures = cell.schemes[scheme];
  const auto published = publishedCulling(cell.altitudeFt, kSchemes[scheme]);
  nlohmann::ordered_json row{{"altitude_ft", cell.altitudeFt},
                             {"scheme", kSchemes[scheme]},
                             {"size", sizeName(cell)},
                             {"place", cell.place},
                             {"triangles", figures.triangles},
                             {"vertices", figures.vertices},
                             {"fps", 1000 / figures.frameMs},
                             {"frame_ms", figures.frameMs},
                             {"cpu_ms", figures.cpuMs},
                             {"cpu_against_frustum", figures.cpuMs / cell.schemes[kFrustum].cpuMs},
                             {"visible_share", figures.visibleTriangles / figures.triangles},
                             {"depth_map", depthMapOf(figures)},
                             {"published_triangles", nullptr},
                             {"published_vertices", nullptr},
                             {"published_fps", nullptr}};
  if (published) {
    row["published_triangles"] = published->triangles;
    row["published_vertices"] = published->vertices;
    row["published_fps"] = published->fps;
  }
  return row;
}

// Table 5's own shape: a block a quantity, ours and theirs.
ReportTable publishedTable(const std::vector<const CullingCell*>& cells, const std::string& title) {
  ReportTable table{.caption = title + ": next to Table 5 of Lee, Park and Kim",
                    .groups = {{"", 1},
                               {"triangles", 3},
                               {"published", 3},
                               {"vertices", 3},
                               {"published", 3},
                               {"fps", 3},
                               {"published", 3}},
                    .columns = {"above ground"}};
  for (int block = 0; block < 3; ++block)
    for (const char* name : {"none", "frustum", "dynamic", "none", "frustum", "proposed"})
      table.columns.push_back(name);
  for (const CullingCell* cell : cells) {
    std::vector<std::string> row{fmt::format("{} ft", cell->altitudeFt)};
    const auto block = [&](auto ours, auto theirs) {
      for (size_t s = 0; s < kPaperSchemes; ++s) row.push_back(ours(cell->schemes[s]));
      for (size_t s = 0; s < kPaperSchemes; ++s) {
        const auto published = publishedCulling(cell->altitudeFt, kSchemes[s]);
        row.push_back(published ? theirs(*published) : "");
      }
    };
    const auto whole = [](double value) { return fmt::format("{:.0f}", value); };
    block([&](const SchemeFigures& f) { return whole(f.triangles); },
          [&](const PublishedCulling& p) { return whole(p.triangles); });
    block([&](const SchemeFigures& f) { return whole(f.vertices); },
          [&](const PublishedCulling& p) { return whole(p.vertices); });
    block([](const SchemeFigures& f) { return fmt::format("{:.1f}", 1000 / f.frameMs); },
          [](const PublishedCulling& p) { return fmt::format("{:.1f}", p.fps); });
    table.rows.push_back(std::move(row));
  }
  return table;
}

ReportTable timeTable(const std::vector<const CullingCell*>& cells, const std::string& title) {
  ReportTable table{.caption = title + ": what a frame costs",
                    .groups = {{"", 1},
                               {"CPU ms", kSchemes.size()},
                               {"wall ms", kSchemes.size()},
                               {"dynamic against frustum", 2},
                               {"dynamic", 2}},
                    .columns = {"above ground"}};
  for (int block = 0; block < 2; ++block) table.columns.insert(table.columns.end(), kSchemes.begin(), kSchemes.end());
  for (const char* name : {"CPU", "triangles", "visible", "depth map"}) table.columns.emplace_back(name);
  for (const CullingCell* cell : cells) {
    std::vector<std::string> row{fmt::format("{} ft", cell->altitudeFt)};
    for (const SchemeFigures& figures : cell->schemes) row.push_back(fmt::format("{:.1f}", figures.cpuMs));
    for (const SchemeFigures& figures : cell->schemes) row.push_back(fmt::format("{:.1f}", figures.frameMs));
    const SchemeFigures &dynamic = cell->schemes[kDynamic], &frustum = cell->schemes[kFrustum];
    row.push_back(fmt::format("{:+.1f} %", 100 * (dynamic.cpuMs / frustum.cpuMs - 1)));
    row.push_back(fmt::format("{:+.1f} %", 100 * (dynamic.triangles / frustum.triangles - 1)));
    row.push_back(percent(dynamic.visibleTriangles / dynamic.triangles));
    row.push_back(depthMapOf(dynamic));
    table.rows.push_back(std::move(row));
  }
  return table;
}

ReportPlot cpuPlot(const std::vector<const CullingCell*>& cells, const std::string& title) {
  ReportPlot plot{.title = title + ": CPU time of a frame", .xLabel = "feet above ground", .yLabel = "ms"};
  for (size_t s = 0; s < kSchemes.size(); ++s) plot.series.push_back({.name = kSchemes[s]});
  for (const CullingCell* cell : cells) {
    plot.categories.push_back(fmt::format("{}", cell->altitudeFt));
    for (size_t s = 0; s < kSchemes.size(); ++s) plot.series[s].y.push_back(cell->schemes[s].cpuMs);
  }
  return plot;
}

bool isLowMountain(const CullingCell& cell) {
  return cell.place == "mountains" && cell.altitudeFt < kLowFt;
}

// Mean over the cells low in the mountains, at the first size.
std::map<std::string, double> passesLowInMountains(const std::vector<CullingCell>& cells, size_t scheme) {
  std::map<std::string, double> mean;
  double count = 0;
  for (const CullingCell& cell : cells) count += isLowMountain(cell) && cell.sizePx == cells.front().sizePx ? 1 : 0;
  for (const CullingCell& cell : cells) {
    if (!isLowMountain(cell) || cell.sizePx != cells.front().sizePx) continue;
    for (const auto& [pass, ms] : cell.schemes[scheme].passMs) mean[pass] += ms / count;
  }
  return mean;
}

void addPasses(const std::vector<CullingCell>& cells, SuiteReport& report) {
  ReportTable table{.caption = "Where the milliseconds go: low in the mountains, " + sizeName(cells.front()) +
                               ", wall time on the device by pass",
                    .columns = {"scheme", "pass", "ms"}};
  nlohmann::ordered_json passes = nlohmann::ordered_json::object();
  for (size_t s = 0; s < kSchemes.size(); ++s) {
    passes[kSchemes[s]] = nlohmann::ordered_json::object();
    for (const auto& [pass, ms] : passesLowInMountains(cells, s)) {
      passes[kSchemes[s]][pass] = ms;
      table.rows.push_back({kSchemes[s], pass, fmt::format("{:.2f}", ms)});
    }
  }
  report.summary["pass_ms"] = std::move(passes);
  report.tables.push_back(std::move(table));
}

double worstLoss(const std::vector<CullingCell>& cells) {
  double worst = -std::numeric_limits<double>::infinity();
  for (const CullingCell& cell : cells)
    worst = std::max(worst, cell.schemes[kDynamic].cpuMs / cell.schemes[kFrustum].cpuMs - 1);
  return worst;
}

}  // namespace

void addView(const SchemeFigures& view, size_t views, SchemeFigures& mean) {
  const double share = 1.0 / static_cast<double>(views);
  mean.triangles += share * view.triangles;
  mean.vertices += share * view.vertices;
  mean.frameMs += share * view.frameMs;
  mean.cpuMs += share * view.cpuMs;
  mean.visibleTriangles += share * view.visibleTriangles;
  for (const auto& [pass, ms] : view.passMs) mean.passMs[pass] += share * ms;
  for (const auto& [name, part] : view.depthMaps) mean.depthMaps[name] += share * part;
}

double savedCpu(const std::vector<CullingCell>& cells, const std::string& scheme, const std::string& place,
                int belowFt) {
  const auto at = static_cast<size_t>(std::ranges::find(kSchemes, scheme) - kSchemes.begin());
  EYE_CHECK(at < kSchemes.size());
  double frustumMs = 0, schemeMs = 0;
  for (const CullingCell& cell : cells) {
    if (cell.place != place || cell.altitudeFt >= belowFt) continue;
    frustumMs += cell.schemes[kFrustum].cpuMs;
    schemeMs += cell.schemes[at].cpuMs;
  }
  return frustumMs > 0 ? 1 - schemeMs / frustumMs : std::numeric_limits<double>::quiet_NaN();
}

double measurementNoise(const std::vector<CullingCell>& cells) {
  double noise = std::numeric_limits<double>::quiet_NaN();
  for (const CullingCell& cell : cells) {
    const SchemeFigures& dynamic = cell.schemes[kDynamic];
    if (dynamic.depthMaps.size() != 1 || !dynamic.depthMaps.contains("off")) continue;
    noise = std::fmax(noise, std::abs(dynamic.cpuMs / cell.schemes[kFrustum].cpuMs - 1));
  }
  return noise;
}

SuiteReport cullingReport(const std::vector<CullingCell>& cells) {
  SuiteReport report{
      .name = "culling",
      .title = "Culling by height",
      .introduction =
          "The same views drawn without culling, with frustum culling (planes and horizon) and "
          "with dynamic culling (also occlusion, by clusters, with the depth map that the "
          "fuzzy selector picks). Frames of all in turn; medians of frames, means of "
          "views. CPU time is that of the whole process.",
  };
  // Blocks of one place and size, in the order of the cells.
  std::vector<std::vector<const CullingCell*>> blocks;
  for (const CullingCell& cell : cells) {
    if (blocks.empty() || blocks.back().back()->place != cell.place || blocks.back().back()->sizePx != cell.sizePx)
      blocks.emplace_back();
    blocks.back().push_back(&cell);
    for (size_t s = 0; s < kSchemes.size(); ++s) report.rows.push_back(rowOf(cell, s));
  }
  const double low = savedCpu(cells, "dynamic", "mountains", kLowFt), loss = worstLoss(cells);
  const double noise = measurementNoise(cells);
  report.summary["saved_cpu_low_level"] = low;
  report.summary["saved_cpu_low_level_plain"] = savedCpu(cells, "dynamic", "plain", kLowFt);
  report.summary["saved_cpu_low_level_320x240"] = savedCpu(cells, "dynamic_320x240", "mountains", kLowFt);
  report.summary["worst_loss"] = loss;
  report.summary["measurement_noise"] = noise;
  report.targets = {{fmt::format("CPU time that dynamic saves below {} ft in the mountains (at least {:.0f} %)", kLowFt,
                                 100 * kSaving),
                     percent(low), low >= kSaving},
                    {fmt::format("Most that dynamic loses against frustum in any row (at most {:.0f} %)", 100 * kLoss),
                     percent(loss), loss <= kLoss}};
  for (const auto& block : blocks) {
    const std::string title = fmt::format("{}, {}", block.front()->place, sizeName(*block.front()));
    report.plots.push_back(cpuPlot(block, title));
    report.tables.push_back(publishedTable(block, title));
    report.tables.push_back(timeTable(block, title));
  }
  addPasses(cells, report);
  report.notes = {
      "Published: Table 5 of paper 001 (Intel i7 980, GTX 470, 10 m imagery round Yecheon, size of the picture not "
      "given, frames capped at 60 a second): compare the ratios between schemes, not the figures.",
      "Altitudes are above the ground of each spot.",
      "Where the selector leaves the depth map off, dynamic does the same work as frustum: how far their times differ "
      "there "
      "(measurement_noise) is what a single row is worth. dynamic_320x240 has the pass in every frame, without the "
      "selector: it tells what the pass saves from what the selector chose.",
      "vertices: those of the chunks drawn. Dynamic draws parts of a chunk, so its figure is the same as frustum's.",
      "visible: the share of the drawn triangles that show at least one pixel's centre, by an identity buffer drawn in "
      "software."};
  return report;
}

}  // namespace eye
