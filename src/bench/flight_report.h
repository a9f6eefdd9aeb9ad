// The flight suite's rows, tables and plots. Pure.
#pragma once

#include <string>
#include <vector>

#include "bench/flight_figures.h"
#include "bench/prediction_study.h"
#include "bench/report.h"

namespace eye {

// One flight from a cold start.
struct FlightRow {
  std::string task, note;  // the note: how a recording was moved
  int published = 0;       // the paper's number of its task; 0: none
  double ssePx = 1;
  int rateHz = 0;
  bool predicted = false;
  double widening = 1;
  FlightLog log;
  FlightFigures figures;
};

// The same flight with all terrain resident and without: after the start of both.
struct PagingCost {
  TimeSummary coldMs, residentMs;
  uint64_t residentBytesRead = 0;  // in the resident pass: 0 where everything stayed
};

struct FlightResults {
  double startS = 3;            // of every flight that does not count after the start
  std::vector<FlightRow> rows;  // the tasks, then recordings
  // For bytes_saved: the row with prediction, and unpredicted ones of the same task and rate, the widening growing.
  FlightRow predicted;
  std::vector<FlightRow> widened;
  PagingCost cost;
  std::vector<PredictionRow> predictions;
};

SuiteReport flightReport(const FlightResults& results);

}  // namespace eye
