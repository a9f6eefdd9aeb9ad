#include "bench/flight_report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "bench/flight_published.h"

namespace eye {
namespace {

constexpr double kLeastSaved = 0.15, kMostCost = 1.10;

constexpr double kPaperSaved = 0.18;

const char* predictorOf(const FlightRow& row) {
  return row.predicted ? "kalman" : "none";
}

std::string mebibytes(uint64_t bytes) {
  return fmt::format("{:.1f}", static_cast<double>(bytes) / (1 << 20));
}

nlohmann::ordered_json jsonOf(const FlightRow& row) {
  const FlightFigures& f = row.figures;
  nlohmann::ordered_json json{{"task", row.task},
                              {"rate_hz", row.rateHz},
                              {"predictor", predictorOf(row)},
                              {"missed_frames", f.missedFrames},
                              {"missing_chunk_frames", f.missingChunkFrames},
                              {"bytes_read", f.paging.bytesRead},
                              {"frame_ms",
                               {{"mean", f.frameMs.mean},
                                {"median", f.frameMs.median},
                                {"p95", f.frameMs.p95},
                                {"p99", f.frameMs.p99},
                                {"max", f.frameMs.max}}},
                              {"cpu_ms", f.cpuMs},
                              {"sse", row.ssePx},
                              {"widening", row.widening},
                              {"duration_s", row.log.durationS},
                              {"frames", f.frames},
                              {"slots", f.slots},
                              {"slots_after_start", f.slotsAfterStart},
                              {"missed_frames_after_start", f.missedAfterStart},
                              {"missing_chunk_frames_after_start", f.missingAfterStart},
                              {"most_missing_chunks_after_start", f.mostMissing},
                              {"smoothness", smoothness(f.missedAfterStart, f.slotsAfterStart)},
                              {"terrain_smoothness", smoothness(f.missingAfterStart, f.framesAfterStart)},
                              {"pager",
                               {{"requested", f.paging.requested},
                                {"loaded", f.paging.loaded},
                                {"refused", f.paging.refused},
                                {"evicted", f.paging.evicted},
                                {"damaged", f.paging.damaged},
                                {"resident", f.paging.resident},
                                {"cached", f.paging.cached},
                                {"gpu_bytes", f.paging.gpuBytes},
                                {"ram_bytes", f.paging.ramBytes},
                                {"interval_s", f.intervalS},
                                {"ahead_s", f.aheadS},
                                {"keeps_up", f.keepsUpShare},
                                {"coarsening", f.coarsening}}}};
  const auto published = publishedFlight(row.published, row.rateHz);
  json["published"] =
      published ? nlohmann::ordered_json(std::string(row.predicted ? published->optimized : published->unoptimized))
                : nlohmann::ordered_json(nullptr);
  json["file_cached_at_start"] =
      row.log.cachedShare ? nlohmann::ordered_json(*row.log.cachedShare) : nlohmann::ordered_json(nullptr);
  if (!row.note.empty()) json["note"] = row.note;
  return json;
}

// Table I's own shape.
ReportTable wordsTable(const std::vector<FlightRow>& rows) {
  ReportTable table{.caption = "In the words of Table I of Hao et al.: frames in time, terrain in time, as published",
                    .columns = {"strategy, task", "frames a second", "frames", "terrain", "published"}};
  for (const bool predicted : {false, true}) {
    for (const FlightRow& row : rows) {
      const auto published = publishedFlight(row.published, row.rateHz);
      if (row.predicted != predicted || !published) continue;
      const FlightFigures& f = row.figures;
      table.rows.push_back(
          {fmt::format("{}, task {}: {}", predicted ? "prediction" : "no prediction", row.published, row.task),
           fmt::format("{}", row.rateHz), smoothness(f.missedAfterStart, f.slotsAfterStart),
           smoothness(f.missingAfterStart, f.framesAfterStart),
           std::string(predicted ? published->optimized : published->unoptimized)});
    }
  }
  return table;
}

ReportTable figuresTable(const std::vector<FlightRow>& rows, double startS) {
  const std::string after = fmt::format("after {:g} s", startS);
  ReportTable table{
      .caption = "Flights from a cold start",
      .groups = {{"", 3}, {"missed frames", 2}, {"frames with chunks missing", 3}, {"", 1}, {"frame, ms", 5}},
      .columns = {"task", "rate", "predictor", "all", after, "all", after, "most chunks", "MiB read", "p50", "p95",
                  "p99", "max", "CPU"}};
  for (const FlightRow& row : rows) {
    const FlightFigures& f = row.figures;
    table.rows.push_back(
        {row.note.empty() ? row.task : row.task + ", " + row.note, fmt::format("{}", row.rateHz), predictorOf(row),
         fmt::format("{} of {}", f.missedFrames, f.slots), fmt::format("{}", f.missedAfterStart),
         fmt::format("{} of {}", f.missingChunkFrames, f.frames), fmt::format("{}", f.missingAfterStart),
         fmt::format("{}", f.mostMissing), mebibytes(f.paging.bytesRead), fmt::format("{:.1f}", f.frameMs.median),
         fmt::format("{:.1f}", f.frameMs.p95), fmt::format("{:.1f}", f.frameMs.p99),
         fmt::format("{:.1f}", f.frameMs.max), fmt::format("{:.1f}", f.cpuMs)});
  }
  return table;
}

ReportTable pagerTable(const std::vector<FlightRow>& rows) {
  ReportTable table{
      .caption = "The pager in these flights",
      .groups = {{"", 3}, {"chunks since the start (refused: groups)", 4}, {"at the end", 3}, {"means", 4}},
      .columns = {"task", "rate", "predictor", "requested", "loaded", "refused", "evicted", "resident", "cached",
                  "GPU MiB", "interval s", "ahead s", "keeps up", "coarsening"}};
  for (const FlightRow& row : rows) {
    const FlightFigures& f = row.figures;
    table.rows.push_back(
        {row.task, fmt::format("{}", row.rateHz), predictorOf(row), fmt::format("{}", f.paging.requested),
         fmt::format("{}", f.paging.loaded), fmt::format("{}", f.paging.refused), fmt::format("{}", f.paging.evicted),
         fmt::format("{}", f.paging.resident), fmt::format("{}", f.paging.cached), mebibytes(f.paging.gpuBytes),
         fmt::format("{:.2f}", f.intervalS), fmt::format("{:.2f}", f.aheadS),
         fmt::format("{:.0f} %", 100 * f.keepsUpShare), fmt::format("{:.2f}", f.coarsening)});
  }
  return table;
}

std::string nameOf(const FlightRow& row) {
  if (row.predicted) return "prediction";
  return row.widening == 1 ? "no prediction" : fmt::format("no prediction, reach x {:g}", row.widening);
}

void addSaving(const FlightResults& results, SuiteReport& report) {
  const FlightRow& predicted = results.predicted;
  ReportTable table{.caption = fmt::format("What reaching as far without prediction costs: {}, {} frames a second",
                                           predicted.task, predicted.rateHz),
                    .columns = {"strategy", "frames with chunks missing", fmt::format("after {:g} s", results.startS),
                                "MiB read", "against prediction"}};
  const auto add = [&](const FlightRow& row) {
    const FlightFigures& f = row.figures;
    table.rows.push_back({nameOf(row), fmt::format("{}", f.missingChunkFrames), fmt::format("{}", f.missingAfterStart),
                          mebibytes(f.paging.bytesRead),
                          fmt::format("{:+.1f} %", 100 * (static_cast<double>(f.paging.bytesRead) /
                                                              static_cast<double>(predicted.figures.paging.bytesRead) -
                                                          1))});
  };
  add(predicted);
  std::vector<WideningTrial> trials;
  for (const FlightRow& row : results.widened) {
    add(row);
    trials.push_back({row.widening, row.figures.missingAfterStart, row.figures.paging.bytesRead});
    if (row.widening != 1) report.rows.push_back(jsonOf(row));
  }
  report.tables.push_back(std::move(table));

  const std::optional<WideningTrial> match = chooseWidening(trials, predicted.figures.missingAfterStart);
  const auto predictedBytes = predicted.figures.paging.bytesRead;
  nlohmann::ordered_json& summary = report.summary;
  summary["bytes_saved"] = nullptr;
  if (match) summary["bytes_saved"] = 1 - static_cast<double>(predictedBytes) / static_cast<double>(match->bytesRead);
  summary["bytes_saved_task"] = predicted.task;
  summary["bytes_saved_rate_hz"] = predicted.rateHz;
  summary["bytes_read_predicted"] = predictedBytes;
  summary["missing_chunk_frames_predicted"] = predicted.figures.missingAfterStart;
  summary["unpredicted_widening"] = match ? nlohmann::ordered_json(match->widening) : nlohmann::ordered_json(nullptr);
  summary["bytes_read_unpredicted"] =
      match ? nlohmann::ordered_json(match->bytesRead) : nlohmann::ordered_json(nullptr);
  summary["missing_chunk_frames_unpredicted"] =
      match ? nlohmann::ordered_json(match->missing) : nlohmann::ordered_json(nullptr);

  const std::string missing =
      fmt::format("{} of {}", predicted.figures.missingAfterStart, predicted.figures.framesAfterStart);
  report.targets.push_back({fmt::format("Frames with a chunk missing after {:g} s: {}, prediction on (none)",
                                        results.startS, predicted.task),
                            missing, predicted.figures.missingAfterStart == 0});
  const std::string what = fmt::format(
      "Bytes that prediction saves against the unpredicted strategy of the same quality (at least {:.0f} "
      "%; published: {:.0f} % at 80 m/s)",
      100 * kLeastSaved, 100 * kPaperSaved);
  if (!match) {
    report.targets.push_back(
        {what, fmt::format("no widening up to {:g} misses as little", results.widened.back().widening), false});
    return;
  }
  const double saved = report.summary["bytes_saved"].get<double>();
  report.targets.push_back(
      {what, fmt::format("{:.1f} % (reach x {:g})", 100 * saved, match->widening), saved >= kLeastSaved});
}

void addCost(const FlightResults& results, SuiteReport& report) {
  const PagingCost& cost = results.cost;
  const double median = cost.coldMs.median / cost.residentMs.median, p99 = cost.coldMs.p99 / cost.residentMs.p99;
  report.summary["paging_cost"] = median;
  report.summary["paging_cost_p99"] = p99;
  report.targets.push_back({fmt::format("Paging's cost: median frame of the flight against the same flight with "
                                        "everything resident (at most {:.2f})",
                                        kMostCost),
                            fmt::format("{:.2f}, p99 {:.2f}", median, p99), median <= kMostCost});
  ReportTable table{.caption = fmt::format("Paging's cost, after {:g} s: ms a frame", results.startS),
                    .columns = {"terrain", "p50", "p95", "p99", "max"}};
  const auto add = [&](const char* name, const TimeSummary& ms) {
    table.rows.push_back({name, fmt::format("{:.2f}", ms.median), fmt::format("{:.2f}", ms.p95),
                          fmt::format("{:.2f}", ms.p99), fmt::format("{:.2f}", ms.max)});
  };
  add("from a cold start", cost.coldMs);
  add("resident", cost.residentMs);
  report.tables.push_back(std::move(table));
  report.notes.push_back(
      fmt::format("The resident flight is the second over the same track in the same process, with "
                  "budgets for all of it; it read {} MiB.",
                  mebibytes(cost.residentBytesRead)));
}

void addPredictions(const std::vector<PredictionRow>& rows, SuiteReport& report) {
  ReportTable table{
      .caption = "How far predictions are off: 300 m/s, 60 Hz, noise of 2 m an axis; metres in space",
      .groups = {{"", 3}, {"here", 2}, {"reference", 2}, {"", 2}},
      .columns = {"manoeuvre", "method", "ahead s", "RMS", "95 %", "RMS", "95 %", "NIS", "within 98 % radius"}};
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  const auto number = [](double value, const char* form) {
    return std::isfinite(value) ? fmt::format(fmt::runtime(form), value) : std::string();
  };
  for (const PredictionRow& row : rows) {
    const auto reference = referencePrediction(row.manoeuvre, row.method, row.horizonS);
    const double none = std::numeric_limits<double>::quiet_NaN();
    const double rmsM = reference ? reference->rmsM : none, p95M = reference ? reference->p95M : none;
    table.rows.push_back({row.manoeuvre, row.method, fmt::format("{:g}", row.horizonS), number(row.rmsM, "{:.3g}"),
                          number(row.p95M, "{:.3g}"), number(rmsM, "{:g}"), number(p95M, "{:g}"),
                          number(row.nisMean, "{:.2f}"), number(100 * row.coverage98, "{:.1f} %")});
    json.push_back({{"manoeuvre", row.manoeuvre},
                    {"method", row.method},
                    {"horizon_s", row.horizonS},
                    {"rms_m", row.rmsM},
                    {"p95_m", row.p95M},
                    {"reference_rms_m", rmsM},
                    {"reference_p95_m", p95M},
                    {"nis", row.nisMean},
                    {"within_98", row.coverage98}});
  }
  report.summary["prediction"] = std::move(json);
  report.tables.push_back(std::move(table));
}

void addPlots(const FlightResults& results, SuiteReport& report) {
  const std::string which = fmt::format("{}, {} frames a second", results.predicted.task, results.predicted.rateHz);
  ReportPlot missing{.title = "Chunks drawn too coarse: " + which, .xLabel = "seconds", .yLabel = "chunks"};
  ReportPlot bytes{.title = "Read from the database: " + which, .xLabel = "seconds", .yLabel = "MiB"};
  std::vector<const FlightRow*> shown{&results.predicted};
  for (const FlightRow& row : results.widened) shown.push_back(&row);
  for (const FlightRow* row : shown) {
    Series chunks{.name = nameOf(*row)}, read{.name = nameOf(*row)};
    for (const FlownFrame& frame : row->log.frames) {
      chunks.x.push_back(frame.timeS);
      chunks.y.push_back(frame.missing);
      read.x.push_back(frame.timeS);
      read.y.push_back(static_cast<double>(frame.bytesRead) / (1 << 20));
    }
    if (row->predicted || row->widening == 1) missing.series.push_back(std::move(chunks));
    bytes.series.push_back(std::move(read));
  }
  report.plots = {std::move(missing), std::move(bytes)};
}

std::string cacheNote(const std::vector<FlightRow>& rows) {
  double most = -1;
  for (const FlightRow& row : rows) most = std::max(most, row.log.cachedShare.value_or(2));
  return most > 1 ? std::string(
                        "The system does not say whether the database's pages were dropped before each flight: "
                        "reading may have been from memory.")
                  : fmt::format(
                        "Before each flight the database's pages were dropped from the system's memory; at most "
                        "{:.1f} % of the file stayed there.",
                        100 * most);
}

}  // namespace

SuiteReport flightReport(const FlightResults& results) {
  SuiteReport report{
      .name = "flight",
      .title = "Flights in real time",
      .introduction =
          "Fast flights 2,000 ft above the mountains of the database, each from a cold start, with and "
          "without prediction of the viewpoint. The clock waits for nobody: a frame that is not there when "
          "its slot is over is missed.",
  };
  for (const FlightRow& row : results.rows) report.rows.push_back(jsonOf(row));
  report.tables = {wordsTable(results.rows), figuresTable(results.rows, results.startS), pagerTable(results.rows)};
  addSaving(results, report);
  addCost(results, report);
  addPredictions(results.predictions, report);
  addPlots(results, report);
  report.summary["start_s"] = results.startS;
  report.notes.insert(report.notes.begin(),
                      {cacheNote(results.rows),
                       "Smooth: fewer than one in 200 frames after the start is missed, or has chunks missing; "
                       "Relatively smooth: fewer than one in ten. The paper gives words alone; its data, its machine "
                       "and the size of its picture are not known.",
                       "Missing: drawn coarser than the tolerance because children were not there yet.",
                       "Without prediction the viewpoint is where it is now; all else is the same. Its reach is the "
                       "distance within which terrain is loaded ahead."});
  return report;
}

}  // namespace eye
