// What the flight suite makes of its flights: slots, counts, words, the widening that is the match, the report.
#include <cmath>
#include <filesystem>
#include <fstream>

#include <unistd.h>
#include <catch2/catch.hpp>

#include "bench/flight_published.h"
#include "bench/flight_report.h"
#include "bench/page_cache.h"

namespace eye {
namespace {

FlightLog log(double durationS, double rateHz, double missingUntilS, uint64_t bytes) {
  FlightLog log;
  log.durationS = durationS;
  for (int i = 0; i < static_cast<int>(durationS * rateHz); ++i) {
    FlownFrame frame{.timeS = i / rateHz, .frameMs = 10, .cpuMs = 20};
    frame.missing = frame.timeS < missingUntilS ? 5 : 0;
    frame.bytesRead = bytes;
    log.frames.push_back(frame);
  }
  log.paging.bytesRead = bytes;
  return log;
}

FlightRow row(bool predicted, double widening, double missingUntilS, uint64_t bytes) {
  FlightRow row{.task = "task",
                .note = {},
                .published = 1,
                .rateHz = 25,
                .predicted = predicted,
                .widening = widening,
                .log = log(10, 25, missingUntilS, bytes),
                .figures = {}};
  row.figures = figuresOf(row.log, 3);
  return row;
}

FlightResults results() {
  FlightResults results;
  results.predicted = row(true, 1, 2, 820);
  results.widened = {row(false, 1, 6, 700), row(false, 1.3, 4, 900), row(false, 1.5, 2.5, 1000)};
  results.rows = {results.widened.front(), results.predicted};
  results.cost.coldMs = summarize({10, 12, 30});
  results.cost.residentMs = summarize({10, 10, 10});
  results.predictions = {{"straight", "kalman9", 1, 5, 9, 1, 0.98, 0}, {"straight", "hold", 1, 300, 303, NAN, NAN, 0}};
  return results;
}

}  // namespace

TEST_CASE("A frame's successor begins with the first slot that it leaves") {
  CHECK(nextSlot(0, 0.010, 0.040) == 1);   // in time
  CHECK(nextSlot(4, 0.1999, 0.040) == 5);  // just so
  CHECK(nextSlot(4, 0.2004, 0.040) == 5);  // a hundredth of a slot late
  CHECK(nextSlot(4, 0.2100, 0.040) == 6);  // one missed
  CHECK(nextSlot(0, 0.1300, 0.040) == 4);  // three missed
  CHECK(nextSlot(7, 0.0, 0.040) == 8);     // never the same again
}

TEST_CASE("Figures of a flight, with and without its start") {
  FlightLog flight = log(10, 10, 4, 77);
  flight.frames[2].missed = 3;
  flight.frames[50].missed = 2;
  flight.frames[60].missing = 9;
  flight.frames[60].keepsUp = false;
  flight.frames[60].frameMs = 500;
  const FlightFigures figures = figuresOf(flight, 3);
  CHECK(figures.frames == 100);
  CHECK(figures.slots == 105);
  CHECK(figures.missedFrames == 5);
  CHECK(figures.missedAfterStart == 2);
  CHECK(figures.slotsAfterStart == 72);
  CHECK(figures.framesAfterStart == 70);
  CHECK(figures.missingChunkFrames == 41);
  CHECK(figures.missingAfterStart == 11);
  CHECK(figures.mostMissing == 9);
  CHECK(figures.frameMs.max == 500);
  CHECK(figures.frameMs.median == 10);
  CHECK(figures.cpuMs == Approx(20));
  CHECK(figures.keepsUpShare == Approx(0.99));
  CHECK(figures.paging.bytesRead == 77);
  CHECK(figuresOf({}, 3).frames == 0);
}

TEST_CASE("The paper's words for lost frames") {
  CHECK(smoothness(0, 1000) == "Smooth");
  CHECK(smoothness(4, 1000) == "Smooth");
  CHECK(smoothness(5, 1000) == "Relatively smooth");
  CHECK(smoothness(99, 1000) == "Relatively smooth");
  CHECK(smoothness(100, 1000) == "Frames drop out");
  CHECK(smoothness(0, 0) == "Smooth");
}

TEST_CASE("The match of prediction is the least widened flight that misses no more") {
  const std::vector<WideningTrial> trials{{3, 0, 900}, {1, 40, 100}, {1.5, 2, 300}, {1.3, 3, 200}, {2, 0, 500}};
  CHECK(chooseWidening(trials, 2)->widening == 1.5);
  CHECK(chooseWidening(trials, 0)->bytesRead == 500);
  CHECK(chooseWidening(trials, 100)->widening == 1);
  CHECK_FALSE(chooseWidening(std::vector<WideningTrial>{{1, 4, 1}}, 3));
}

TEST_CASE("Every cell of the paper's table and the reference of predictions are at hand") {
  for (const int task : {1, 2, 3})
    for (const int rateHz : {15, 25, 100}) CHECK(publishedFlight(task, rateHz));
  CHECK(publishedFlight(1, 100)->unoptimized == "Frames drop out");
  CHECK_FALSE(publishedFlight(0, 25));
  for (const ReferencePrediction& reference : kReferencePredictions) {
    bool isManoeuvre = false;
    for (const Manoeuvre manoeuvre : kManoeuvres) isManoeuvre |= reference.manoeuvre == manoeuvreName(manoeuvre);
    CHECK(isManoeuvre);
  }
}

TEST_CASE("The report says what prediction saves against the match") {
  const SuiteReport report = flightReport(results());
  CHECK(report.summary["bytes_saved"].get<double>() == Approx(0.18));
  CHECK(report.summary["unpredicted_widening"] == 1.5);
  CHECK(report.summary["bytes_read_unpredicted"] == 1000);
  CHECK(report.summary["paging_cost"].get<double>() == Approx(1.2));
  CHECK(report.summary["prediction"][0]["reference_rms_m"] == 4.5);
  REQUIRE(report.rows.size() == 4);  // two flights, two widened ones
  CHECK(report.rows[0]["published"] == "Relatively smooth");
  CHECK(report.rows[1]["published"] == "Smooth");
  CHECK(report.rows[3]["widening"] == 1.5);
  REQUIRE(report.targets.size() == 3);
  CHECK(report.targets[0].isReached);
  CHECK(report.targets[1].isReached);
  CHECK_FALSE(report.targets[2].isReached);
  for (const ReportPlot& plot : report.plots) CHECK(plot.series.size() >= 2);
}

TEST_CASE("Without a match nothing is saved, and the report says so") {
  FlightResults none = results();
  none.widened.pop_back();
  const SuiteReport report = flightReport(none);
  CHECK(report.summary["bytes_saved"].is_null());
  CHECK(report.summary["unpredicted_widening"].is_null());
  CHECK_FALSE(report.targets[1].isReached);
  CHECK(report.targets[1].measured.find("1.3") != std::string::npos);
}

TEST_CASE("A file's pages are dropped, or the system does not say") {
  const auto path = std::filesystem::temp_directory_path() / ("eye_pages_" + std::to_string(getpid()));
  std::ofstream(path) << std::string(100000, 'x');
  const std::optional<double> share = dropFromPageCache(path);
  if (share) CHECK((*share >= 0 && *share <= 1));
  std::filesystem::remove(path);
  CHECK_FALSE(dropFromPageCache(path));
}

}  // namespace eye
