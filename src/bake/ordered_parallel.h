// Work done by many threads whose results are taken in order.
#pragma once

#include <algorithm>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <map>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace eye {

// Calls produce(i) for i in [0, count) on `jobs` threads and consume(i, result) on the caller's, in ascending order. No
// more than a few results a thread wait at any time. `consume` returns false to stop: nothing new is begun.
template <class T>
void orderedParallel(size_t count, int jobs, const std::function<T(size_t)>& produce,
                     const std::function<bool(size_t, T&&)>& consume) {
  const auto threads = static_cast<size_t>(std::max(1, jobs));
  const size_t ahead = 4 * threads;
  std::mutex mutex;
  std::condition_variable changed;
  std::map<size_t, T> finished;
  size_t nextToBegin = 0, nextToConsume = 0;
  bool stopped = false;

  const auto work = [&] {
    std::unique_lock lock(mutex);
    for (;;) {
      changed.wait(lock, [&] { return stopped || nextToBegin >= count || nextToBegin < nextToConsume + ahead; });
      if (stopped || nextToBegin >= count) return;
      const size_t index = nextToBegin++;
      lock.unlock();
      T result = produce(index);
      lock.lock();
      finished.emplace(index, std::move(result));
      changed.notify_all();
    }
  };
  std::vector<std::jthread> workers;
  for (size_t i = 0; i < std::min(threads, count); ++i) workers.emplace_back(work);

  std::unique_lock lock(mutex);
  while (nextToConsume < count) {
    changed.wait(lock, [&] { return finished.contains(nextToConsume); });
    T result = std::move(finished.extract(nextToConsume).mapped());
    lock.unlock();
    const bool goOn = consume(nextToConsume, std::move(result));
    lock.lock();
    ++nextToConsume;
    stopped = !goOn;
    changed.notify_all();
    if (stopped) break;
  }
}

}  // namespace eye
