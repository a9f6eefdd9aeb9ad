// The pager: a thread that owns disk and decode, and the one call a frame in which render thread and paging thread
// meet.
#pragma once

#include <memory>

#include "paging/lod_select.h"
#include "paging/schedule.h"
#include "paging/terrain_cache.h"
#include "terrain/database.h"

namespace eye {

struct PagerOptions {
  uint64_t ramBudgetBytes = uint64_t{128} << 20;  // decoded chunks waiting or kept for return
  uint64_t uploadBytesPerFrame = uint64_t{4} << 20;
  double uploadMsPerFrame = 2;
  bool wait = false;  // --offline: exchange() returns when nothing that is wanted is missing (the caller selects again)
};

struct PagingCounts {  // since the start, but for the first block
  uint64_t resident = 0, ramBytes = 0, gpuBytes = 0;
  uint64_t cached = 0;  // chunks that are decoded and not on the GPU
  uint64_t requested = 0, loaded = 0, evicted = 0, bytesRead = 0, damaged = 0;
  uint64_t refused = 0;  // times that a group was loaded and the GPU's budget had no room for it
};

// How the pager keeps up; all 0 without a look-ahead.
struct PagingPace {
  Interval interval{0, true};
  double memoryS = 0, cacheS = 0;  // how far ahead the two areas reach
  PagingRates rates;
};

class Pager {
 public:
  // Reads and uploads the eight roots before it returns: they are always resident.
  static Result<std::unique_ptr<Pager>> create(const std::string& databasePath, GpuStore& gpu,
                                               const PagerOptions& options);
  ~Pager();

  TerrainCache& cache();
  const DatabaseInfo& info() const;
  // Hands over what is wanted (all of it: what is not in the list any more is cancelled), takes in what is loaded
  // within the upload budget, evicts where a budget is short. `ahead`: also loads what is needed before long; null:
  // only what the selection misses. Returns chunks taken in. With options.wait: looks nowhere ahead, waits for at least
  // one wanted chunk, and returns 0 when none can come.
  int exchange(const Selection& selection, const LookAhead* ahead = nullptr);
  // By how much the next selection's tolerance is to be coarser than asked for: 1, or more while the GPU's budget is
  // too small for what is seen.
  double coarsening() const;
  PagingCounts counts() const;
  PagingPace pace() const;
  double threadCpuMs() const;  // of reading and decoding, so far

 private:
  struct Impl;
  explicit Pager(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace eye
