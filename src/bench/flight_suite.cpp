// Suite `flight`: paper 000's Table I and its saving, in real time.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "bench/flight_report.h"
#include "bench/flight_tasks.h"
#include "bench/suites.h"

namespace eye {
namespace {

constexpr double kFlightS = 40, kQuickFlightS = 2;
// Terrain for the first picture has to come from somewhere.
constexpr double kStartS = 3, kQuickStartS = 1;
constexpr std::array kRatesHz{15, 25, 100};
constexpr int kMainRateHz = 25;  // of recordings, bytes_saved and paging_cost; the paper: what is required
constexpr size_t kMainTask = 1;  // of the built-in ones: 300 m/s with the default tolerance
constexpr std::array kWidenings{1.0, 1.15, 1.3, 1.5, 2.0, 3.0, 4.0};
constexpr std::array kQuickWidenings{1.0, 1.5, 3.0};
// The match is narrowed down between the first that misses as little and the last that does not.
constexpr double kNarrowEnough = 1.05, kQuickNarrowEnough = 1.3;
constexpr size_t kMostNarrowings = 4;
constexpr uint64_t kAllMiB = 1024;  // budgets in which a flight stays whole
constexpr int kCostPairs = 3;       // cold and resident in turn, so that a busy minute slows both
constexpr double kStudyS = 90, kQuickStudyS = 20, kStudySigmaM = 2;
constexpr uint32_t kStudySeed = 1;

class Flights {
 public:
  Flights(const SuiteOptions& options, size_t steps) : options_(options), steps_(static_cast<double>(steps)) {}

  // From a cold start.
  Result<FlightRow> fly(const FlightTask& task, int rateHz, bool predicted, double widening) {
    begin(fmt::format("{}, {} a second, prediction {}{}", task.name, rateHz, predicted ? "on" : "off",
                      widening == 1 ? "" : fmt::format(", reach x {:g}", widening)));
    FlightSetting setting{.options = optionsFor(task), .rateHz = static_cast<double>(rateHz)};
    setting.options.predictor = predicted ? PredictorMode::kalman : PredictorMode::none;
    setting.options.regionWidening = widening;
    Result<FlightLog> log = flyCold(setting, task.track);
    if (!log) return tl::unexpected(log.error());
    FlightRow row{.task = task.name,
                  .note = {},
                  .published = task.published,
                  .ssePx = task.ssePx,
                  .rateHz = rateHz,
                  .predicted = predicted,
                  .widening = widening,
                  .log = std::move(*log),
                  .figures = {}};
    row.figures = figuresOf(row.log, startS());
    return row;
  }

  // The same track twice in one generator whose budgets hold all of it, and all of that again.
  Result<PagingCost> costOf(const FlightTask& task) {
    Options options = optionsFor(task);
    options.cacheGpuMiB = options.cacheRamMiB = kAllMiB;
    options.depthMap = DepthMapMode::off;  // what the selector picks is not paging's cost
    std::vector<double> coldMs, residentMs;
    uint64_t residentBytesRead = 0;
    for (int pair = 0; pair < costPairs(); ++pair) {
      Result<SteeredGenerator> generator = SteeredGenerator::create(options, false);
      if (!generator) return tl::unexpected(generator.error());
      device_ = generator->generator().renderer().device().name;
      double clockS = 0;
      for (std::vector<double>* frameMs : {&coldMs, &residentMs}) {
        begin(frameMs == &coldMs ? "what paging costs: from a cold start" : "what paging costs: everything resident");
        const Result<FlightLog> log = eye::fly(*generator, task.track, kMainRateHz, clockS);
        if (!log) return tl::unexpected(log.error());
        for (const FlownFrame& frame : log->frames)
          if (frame.timeS >= startS()) frameMs->push_back(frame.frameMs);
        if (frameMs == &residentMs) residentBytesRead += log->frames.back().bytesRead;
      }
    }
    return PagingCost{.coldMs = summarize(std::move(coldMs)),
                      .residentMs = summarize(std::move(residentMs)),
                      .residentBytesRead = residentBytesRead};
  }

  // The unpredicted flight that misses as little as the predicted one with the least reach; `flown` holds those at the
  // reach that is needed, and then all of them, the reach growing.
  Result<void> widen(const FlightTask& task, std::span<const double> widenings, size_t missing,
                     std::vector<FlightRow>& flown) {
    const auto isMatch = [missing](const FlightRow& row) { return row.figures.missingAfterStart <= missing; };
    for (const double widening : widenings.subspan(1)) {
      if (isMatch(flown.back())) break;  // more would only read more
      Result<FlightRow> row = fly(task, kMainRateHz, false, widening);
      if (!row) return tl::unexpected(row.error());
      flown.push_back(std::move(*row));
    }
    const double narrowEnough = options_.quick ? kQuickNarrowEnough : kNarrowEnough;
    for (auto match = std::ranges::find_if(flown, isMatch); match != flown.begin() && match != flown.end();
         match = std::ranges::find_if(flown, isMatch)) {
      const double below = std::prev(match)->widening;
      if (match->widening / below <= narrowEnough) break;
      Result<FlightRow> row = fly(task, kMainRateHz, false, std::sqrt(below * match->widening));
      if (!row) return tl::unexpected(row.error());
      flown.insert(match, std::move(*row));
    }
    return {};
  }

  double startS() const { return options_.quick ? kQuickStartS : kStartS; }
  int costPairs() const { return options_.quick ? 1 : kCostPairs; }
  double flightS() const { return options_.quick ? kQuickFlightS : kFlightS; }
  const std::string& device() const { return device_; }

 private:
  void begin(const std::string& what) {
    if (options_.progress) options_.progress(what, done_ / steps_);
    ++done_;
  }
  Options optionsFor(const FlightTask& task) const {
    Options options;
    options.terrain = options_.terrain;
    options.device = options_.device;
    options.ssePx = task.ssePx;
    return options;
  }

  const SuiteOptions& options_;
  double steps_, done_ = 0;
  std::string device_;
};

std::vector<PredictionRow> predictions(bool quick) {
  std::vector<PredictionRow> rows;
  for (const Manoeuvre manoeuvre : kManoeuvres) {
    const std::vector<TrackSample> truth = simulatedTrack(manoeuvre, quick ? kQuickStudyS : kStudyS);
    const auto study =
        studyPrediction(manoeuvreName(manoeuvre), withNoise(truth, kStudySigmaM, kStudySeed), Track(truth));
    rows.insert(rows.end(), study.begin(), study.end());
  }
  return rows;
}

std::string noteOf(const FlightTask& task) {
  std::string note = task.isMoved ? "moved to the middle of the terrain" : "where it was flown";
  if (task.raisedM > 0) note += fmt::format(", raised by {:.0f} m", task.raisedM);
  return note;
}

}  // namespace

Result<SuiteReport> runFlightSuite(const SuiteOptions& options) {
  const Result<DatabaseReader> reader =
      DatabaseReader::open(options.terrain.empty() ? defaultTerrainPath() : options.terrain);
  if (!reader) return tl::unexpected(reader.error());
  const auto places = findPlaces(*reader);
  if (!places) return tl::unexpected(places.error());
  const std::vector<int> ratesHz =
      options.quick ? std::vector<int>{kMainRateHz} : std::vector<int>(kRatesHz.begin(), kRatesHz.end());
  const std::span<const double> widenings =
      options.quick ? std::span<const double>(kQuickWidenings) : std::span<const double>(kWidenings);
  constexpr size_t kTasks = 3, kStrategies = 2;
  const size_t costFlights = options.quick ? 2 : 2 * kCostPairs;
  Flights flights(options, kTasks * kStrategies * ratesHz.size() + kStrategies * options.tracks.size() +
                               widenings.size() - 1 + kMostNarrowings + costFlights);

  GroundHeights ground(*reader);
  const auto tasks = builtInTasks((*places)[1], ground, flights.flightS());
  if (!tasks) return tl::unexpected(tasks.error());
  // Before the first flight: a track that cannot be read is told at once.
  std::vector<FlightTask> recorded;
  for (const std::string& path : options.tracks) {
    Result<FlightTask> task = recordedTask(path, reader->info().dataBounds, ground, flights.flightS());
    if (!task) return tl::unexpected(task.error());
    recorded.push_back(std::move(*task));
  }

  FlightResults results;
  results.startS = flights.startS();
  for (const FlightTask& task : *tasks) {
    for (const int rateHz : ratesHz) {
      for (const bool predicted : {false, true}) {
        Result<FlightRow> row = flights.fly(task, rateHz, predicted, 1);
        if (!row) return tl::unexpected(row.error());
        results.rows.push_back(std::move(*row));
      }
    }
  }
  for (const FlightTask& task : recorded) {
    for (const bool predicted : {false, true}) {
      Result<FlightRow> row = flights.fly(task, kMainRateHz, predicted, 1);
      if (!row) return tl::unexpected(row.error());
      row->note = noteOf(task);
      results.rows.push_back(std::move(*row));
    }
  }
  const FlightTask& mainTask = (*tasks)[kMainTask];
  for (const FlightRow& row : results.rows) {
    if (row.task != mainTask.name || row.rateHz != kMainRateHz) continue;
    if (row.predicted)
      results.predicted = row;
    else
      results.widened.push_back(row);
  }
  const Result<void> widened =
      flights.widen(mainTask, widenings, results.predicted.figures.missingAfterStart, results.widened);
  if (!widened) return tl::unexpected(widened.error());
  const Result<PagingCost> cost = flights.costOf(mainTask);
  if (!cost) return tl::unexpected(cost.error());
  results.cost = *cost;
  results.predictions = predictions(options.quick);
  SuiteReport report = flightReport(results);
  report.device = flights.device();
  return report;
}

}  // namespace eye
