// What a run leaves behind when it ends. Each output is tried, whatever became of the others.
#pragma once

#include <optional>

#include "app/image_generator.h"
#include "app/options.h"

namespace eye {

// That the outputs' folders are there and may be written to: found out before the flight.
Result<void> checkOutputs(const Options& options);

// --screenshot and --distance-map, from the last frame drawn, which has been read back.
Result<void> writeScreenshot(const Options& options, const ImageGenerator& generator);
Result<void> writeDistances(const Options& options, const ImageGenerator& generator);

// Metres along each pixel's ray from reversed-Z depth, NaN where there is sky.
std::vector<float> slantRange(std::span<const float> depth, const View& view);

// The first of several errors is the run's; those behind it go to the log, so that none is lost.
class FirstError {
 public:
  // True where the result is no error.
  bool keep(const Result<void>& result);
  Result<void> result() const;

 private:
  std::optional<Error> error_;
};

}  // namespace eye
