#include "paging/paging_thread.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>

#include "telemetry/cpu_time.h"
#include "telemetry/trace.h"

namespace eye {
namespace {

constexpr int kNiceness = 10;

// On Linux a thread has a niceness of its own. Where it may not be lowered, paging goes on at the ordinary one.
void lowerPriority() {
  setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), kNiceness);
}

}  // namespace

PagingThread::PagingThread(DatabaseReader reader, uint64_t ramBudgetBytes)
    : reader_(std::move(reader)),
      ramBudgetBytes_(ramBudgetBytes),
      bytesRead_(reader_.bytesRead()),
      thread_([this] { run(); }) {}

PagingThread::~PagingThread() {
  {
    const std::lock_guard lock(mutex_);
    isStopping_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

PagingThread::Taken PagingThread::take(std::vector<LoadResult>& results) {
  const std::lock_guard lock(mutex_);
  for (LoadResult& result : results_) results.push_back(std::move(result));
  results_.clear();
  resultBytes_ = 0;
  roomBytes_ = 0;
  return {blockedBytes_, bytesRead_};
}

void PagingThread::request(const std::vector<TileKey>& parents, uint64_t roomBytes) {
  bool wakes = false;
  {
    const std::lock_guard lock(mutex_);
    requests_.assign(parents.rbegin(), parents.rend());
    roomBytes_ = roomBytes;
    if (blocked_ && resultBytes_ + blockedBytes_ <= roomBytes_) {
      deliver(std::move(*blocked_), blockedBytes_);
      blocked_.reset();
      blockedBytes_ = 0;
      wakes = true;
    }
    for (const LoadResult& result : results_) forget(result.parent);
    if (blocked_) forget(blocked_->parent);
    wakes |= !requests_.empty() && !blocked_;
  }
  if (wakes) wake_.notify_one();
}

void PagingThread::waitForResult() {
  std::unique_lock lock(mutex_);
  done_.wait(lock, [this] { return !results_.empty() || blocked_ || (requests_.empty() && !isLoading_); });
}

uint64_t PagingThread::resultBytes() const {
  const std::lock_guard lock(mutex_);
  return resultBytes_;
}

double PagingThread::cpuMs() {
  return threadCpuMs(thread_.native_handle());
}

void PagingThread::forget(const TileKey& parent) {
  std::erase(requests_, parent);
}

void PagingThread::run() {
  nameThread("paging");
  lowerPriority();
  std::unique_lock lock(mutex_);
  for (;;) {
    wake_.wait(lock, [this] { return isStopping_ || !requests_.empty(); });
    if (isStopping_) return;
    const TileKey parent = requests_.back();
    requests_.pop_back();
    isLoading_ = true;
    lock.unlock();

    LoadCost cost;
    Result<ChunkGroup> group = loadGroup(reader_, parent, &cost);
    LoadResult result{parent, std::move(group), cost};
    uint64_t bytes = result.group ? result.group->bytes() : 0;
    if (bytes > ramBudgetBytes_) {
      result.group =
          fail(ErrorKind::noSpace, fmt::format("children of {}: {} bytes are more than the whole RAM budget of "
                                               "{}; raise --cache-ram",
                                               parent.name(), bytes, ramBudgetBytes_));
      bytes = 0;
    }

    lock.lock();
    bytesRead_ = reader_.bytesRead();
    isLoading_ = false;
    forget(parent);  // asked for again meanwhile
    if (bytes == 0 || resultBytes_ + bytes <= roomBytes_) {
      deliver(std::move(result), bytes);
      continue;
    }
    blocked_ = std::move(result);
    blockedBytes_ = bytes;
    done_.notify_one();
    wake_.wait(lock, [this] { return isStopping_ || !blocked_; });
  }
}

void PagingThread::deliver(LoadResult result, uint64_t bytes) {
  resultBytes_ += bytes;
  results_.push_back(std::move(result));
  done_.notify_one();
}

}  // namespace eye
