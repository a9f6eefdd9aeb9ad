// Pages of elevation in a bounded memory: made once however many threads ask, the least recently used dropped.
#pragma once

#include <condition_variable>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <unordered_map>

#include "bake/elevation_layer.h"

namespace eye {

struct PageId {
  uint32_t layer = 0;
  int32_t row = 0, column = 0;
  bool operator==(const PageId&) const = default;
};

// Thread: any number at once.
class PageCache {
 public:
  using Page = std::shared_ptr<const ElevationPage>;

  explicit PageCache(size_t budgetBytes) : budgetBytes_(budgetBytes) {}
  // `make` runs without the lock; it may ask for pages of other layers, never of its own.
  Page get(const PageId& id, const std::function<Page()>& make);

 private:
  struct Hash {
    size_t operator()(const PageId& id) const {
      const uint64_t mixed = (uint64_t{id.layer} << 58) ^ (uint64_t{uint32_t(id.row)} << 29) ^ uint32_t(id.column);
      return static_cast<size_t>(mixed * 0x9E3779B97F4A7C15ull);
    }
  };
  struct Entry {
    Page page;  // null while it is being made
    std::list<PageId>::iterator use;
  };

  const size_t budgetBytes_;
  std::mutex mutex_;
  std::condition_variable made_;
  std::unordered_map<PageId, Entry, Hash> entries_;
  std::list<PageId> byUse_;  // newest first; only finished pages
  size_t bytes_ = 0;
};

}  // namespace eye
