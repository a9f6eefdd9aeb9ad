#include "bake/page_cache.h"

namespace eye {

PageCache::Page PageCache::get(const PageId& id, const std::function<Page()>& make) {
  std::unique_lock lock(mutex_);
  for (;;) {
    const auto found = entries_.find(id);
    if (found == entries_.end()) break;
    if (found->second.page) {
      byUse_.splice(byUse_.begin(), byUse_, found->second.use);
      return found->second.page;
    }
    made_.wait(lock);
  }
  entries_.emplace(id, Entry{nullptr, byUse_.end()});
  lock.unlock();
  Page page = make();
  lock.lock();
  byUse_.push_front(id);
  entries_[id] = Entry{page, byUse_.begin()};
  bytes_ += page->bytes();
  while (bytes_ > budgetBytes_ && byUse_.size() > 1) {
    const auto oldest = entries_.find(byUse_.back());
    bytes_ -= oldest->second.page->bytes();
    entries_.erase(oldest);
    byUse_.pop_back();
  }
  lock.unlock();
  made_.notify_all();
  return page;
}

}  // namespace eye
