// The thread that reads and decodes. It is told the parents whose children are wanted, most urgent first, and gives
// back groups or errors; everything that the two threads share lies behind one mutex. Runs at low priority, so that on
// a small machine it yields to the render thread.
#pragma once

#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

#include "paging/chunk_loader.h"

namespace eye {

struct LoadResult {
  TileKey parent;
  Result<ChunkGroup> group;  // noSpace: bigger than the whole RAM budget
  LoadCost cost;
};

class PagingThread {
 public:
  PagingThread(DatabaseReader reader, uint64_t ramBudgetBytes);
  ~PagingThread();  // when the group at hand is done
  PagingThread(const PagingThread&) = delete;
  PagingThread& operator=(const PagingThread&) = delete;

  struct Taken {
    uint64_t blockedBytes = 0;  // of a decoded group that waits for room
    uint64_t bytesRead = 0;     // of the file, since it was opened
  };
  // Appends what is loaded. Until the next request the thread may hold back further results: their bytes are no longer
  // counted here, and the caller has not yet said what room is left.
  Taken take(std::vector<LoadResult>& results);
  // Replaces the list, but for what is being loaded; results may take up `roomBytes`.
  void request(const std::vector<TileKey>& parents, uint64_t roomBytes);
  // Until there is a result to take or one waits for room; at once where nothing is under way.
  void waitForResult();
  uint64_t resultBytes() const;
  double cpuMs();  // that the thread has taken so far

 private:
  void run();
  void deliver(LoadResult result, uint64_t bytes);
  void forget(const TileKey& parent);  // from the request list

  const DatabaseReader reader_;  // the thread's alone
  const uint64_t ramBudgetBytes_;

  mutable std::mutex mutex_;
  std::condition_variable wake_, done_;
  std::vector<TileKey> requests_;  // most urgent last
  std::vector<LoadResult> results_;
  std::optional<LoadResult> blocked_;  // waits for room for blockedBytes_
  uint64_t resultBytes_ = 0, roomBytes_ = 0, blockedBytes_ = 0, bytesRead_;
  bool isLoading_ = false, isStopping_ = false;

  std::thread thread_;  // last: it starts when all else is there
};

}  // namespace eye
