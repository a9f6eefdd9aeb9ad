// --stats, one JSON object a frame, and --summary, one for the run, with the keys that docs/STATISTICS.md lists.
// Owner thread: render.
#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "app/frame_record.h"
#include "base/error.h"

namespace eye {

class StatisticsFile {
 public:
  static Result<StatisticsFile> create(const std::string& path);
  Result<void> write(const FrameRecord& record);
  Result<void> close();  // the error of a full disk shows here at the latest

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::string path_;
  std::unique_ptr<std::FILE, Closer> file_;
};

struct TimeSummary {
  double mean = 0, median = 0, p95 = 0, p99 = 0, max = 0;
};
TimeSummary summarize(std::vector<double> values);

// Collects a run. Only drawn frames count towards times, triangles and vertices.
class RunSummary {
 public:
  void add(const FrameRecord& record);
  uint64_t frames() const { return frames_; }
  const std::vector<double>& frameTimesMs() const { return frameMs_; }
  uint64_t missingChunkFrames() const { return missingChunkFrames_; }
  uint32_t mostMissing() const { return mostMissing_; }   // chunks in one frame
  const PagingCounts& paging() const { return paging_; }  // of the last frame
  Result<void> write(const std::string& path, const std::string& device, double startupMs,
                     const std::string& settings) const;

 private:
  std::vector<double> frameMs_;
  uint64_t frames_ = 0, overBudget_ = 0, missingChunkFrames_ = 0;
  uint32_t mostMissing_ = 0;
  PagingCounts paging_;
  double triangles_ = 0, vertices_ = 0, cpuMs_ = 0;
};

uint64_t peakRssBytes();

}  // namespace eye
