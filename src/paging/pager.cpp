#include "paging/pager.h"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_set>

#include "paging/chunk_loader.h"
#include "paging/paging_thread.h"
#include "paging/ram_cache.h"
#include "telemetry/trace.h"

namespace eye {
namespace {

// A group must have been out of every walk for this many frames before it makes room for another, so that an eye that
// sways does not load and evict in turns. When waiting, frames are steps of one and the same view: one is enough.
constexpr uint64_t kIdleFrames = 8;
// Of the RAM budget, kept free for results that are on their way; a group that needs more gets it when it is known.
constexpr uint64_t kRoomShare = 4;

ResidentChunk residentFrom(const LoadedChunk& chunk, const GpuChunk& gpu) {
  return {chunk.meta, gpu, chunk.skirts, chunk.surfaceIndexCount};
}

}  // namespace

struct Pager::Impl {
  Impl(DatabaseReader reader, GpuStore& gpuStore, const PagerOptions& pagerOptions)
      : gpu(gpuStore), options(pagerOptions), info(reader.info()), thread(std::move(reader), options.ramBudgetBytes) {}
  ~Impl();

  // The groups that a selection wants and that may yet come, most urgent first.
  void listWantedGroups(const Selection& selection);
  void takeResults();
  void trimRam();
  // What is wanted and not in RAM, from `begin` on; nothing while the GPU has no room for what is there already.
  void sendRequests(size_t begin);
  // The children of `parent` into the forest; false where there is no room for them.
  bool takeIn(const ChunkGroup& group);
  std::optional<std::vector<ResidentChunk>> upload(const ChunkGroup& group);
  bool canEvict();
  bool evictOne();
  void evict(uint32_t parent);
  int takeInWithinBudget();
  int takeInAll();

  GpuStore& gpu;
  const PagerOptions options;
  const DatabaseInfo info;
  TerrainCache cache;
  RamCache ram;
  PagingCounts counts;
  std::unordered_set<TileKey> lost;   // parents whose children cannot be had: damaged, or too big for the RAM budget
  std::unordered_set<TileKey> asked;  // the last request list, to count what is new in it
  bool isGpuFull = false;             // an upload failed, and nothing could be evicted for it
  uint64_t blockedBytes = 0;

  // Kept from frame to frame so that they do not allocate.
  std::vector<TileKey> wanted, requests;
  std::vector<LoadResult> results;
  std::vector<uint32_t> evictable;  // least recently used last; made when first needed in an exchange
  bool isEvictableListed = false;

  PagingThread thread;  // last: it is joined before anything else goes
};

Pager::Impl::~Impl() {
  for (uint32_t root : cache.roots()) {
    std::vector<uint32_t> parents{root};
    while (!parents.empty()) {
      const uint32_t node = parents.back();
      parents.pop_back();
      gpu.release(cache.node(node).gpu);
      const uint32_t first = cache.node(node).firstChild;
      for (uint32_t i = 0; i < cache.children(node).size(); ++i) parents.push_back(first + i);
    }
  }
}

void Pager::Impl::listWantedGroups(const Selection& selection) {
  wanted.clear();
  for (const WantedChunk& chunk : selection.wanted) {
    const std::optional<TileKey> parent = chunk.key.parent();
    if (!parent || (!wanted.empty() && wanted.back() == *parent) || lost.contains(*parent)) continue;
    const std::optional<uint32_t> node = cache.find(*parent);
    if (node && cache.children(*node).empty()) wanted.push_back(*parent);
  }
}

void Pager::Impl::takeResults() {
  results.clear();
  const PagingThread::Taken taken = thread.take(results);
  blockedBytes = taken.blockedBytes;
  counts.bytesRead = taken.bytesRead;
  for (LoadResult& result : results) {
    if (result.group) {
      // A parent that went while its children were on their way does not want them any more.
      if (cache.find(result.parent)) ram.insert(std::move(*result.group));
      continue;
    }
    lost.insert(result.parent);
    if (result.group.error().kind != ErrorKind::noSpace) ++counts.damaged;
  }
  results.clear();
}

void Pager::Impl::trimRam() {
  const uint64_t room = std::min(options.ramBudgetBytes, std::max(options.ramBudgetBytes / kRoomShare, blockedBytes));
  ram.trim(options.ramBudgetBytes - room);
}

void Pager::Impl::sendRequests(size_t begin) {
  requests.clear();
  uint64_t waitingBytes = 0;
  // What is decoded and waits for its upload takes RAM: beyond half of the budget more would only push out the first.
  for (size_t i = begin; i < wanted.size() && !isGpuFull && waitingBytes <= options.ramBudgetBytes / 2; ++i) {
    if (lost.contains(wanted[i])) continue;
    const ChunkGroup* group = ram.use(wanted[i]);
    if (group != nullptr) {
      waitingBytes += group->bytes();
    } else {
      requests.push_back(wanted[i]);
    }
  }
  for (const TileKey& parent : requests) {
    if (!asked.contains(parent)) counts.requested += static_cast<uint64_t>(parent.children().count);
  }
  asked.clear();
  asked.insert(requests.begin(), requests.end());
  trimRam();
  thread.request(requests, options.ramBudgetBytes - ram.bytes());
}

std::optional<std::vector<ResidentChunk>> Pager::Impl::upload(const ChunkGroup& group) {
  std::vector<ResidentChunk> uploaded;
  for (const LoadedChunk& chunk : group.chunks) {
    const std::optional<GpuChunk> place = gpu.upload(chunk);
    if (!place) {
      for (const ResidentChunk& done : uploaded) gpu.release(done.gpu);
      return std::nullopt;
    }
    uploaded.push_back(residentFrom(chunk, *place));
  }
  return uploaded;
}

bool Pager::Impl::takeIn(const ChunkGroup& group) {
  for (;;) {
    if (const auto uploaded = upload(group)) {
      cache.insertChildren(*cache.find(group.parent), *uploaded);
      counts.loaded += uploaded->size();
      return true;
    }
    if (evictOne()) continue;
    ++counts.refused;
    return false;
  }
}

bool Pager::Impl::canEvict() {
  if (!isEvictableListed || evictable.empty()) {  // again when empty: parents of what has gone may be leaves now
    const uint64_t idleFrames = options.wait ? 0 : kIdleFrames;
    cache.leafGroupsUnusedSince(cache.frame() - std::min(cache.frame(), idleFrames), evictable);
    std::ranges::reverse(evictable);
    isEvictableListed = true;
  }
  return !evictable.empty();
}

bool Pager::Impl::evictOne() {
  if (!canEvict()) return false;
  evict(evictable.back());
  evictable.pop_back();
  return true;
}

void Pager::Impl::evict(uint32_t parent) {
  for (const CacheNode& child : cache.children(parent)) {
    gpu.release(child.gpu);
    ++counts.evicted;
  }
  ram.use(cache.node(parent).meta.key);  // if it is still there, it is now the only copy
  cache.removeChildren(parent);
}

// At least one group, then while the budget lasts.
int Pager::Impl::takeInWithinBudget() {
  const TraceScope trace("upload");
  const int64_t beginNs = monotonicNs();
  uint64_t bytes = 0;
  int taken = 0;
  for (const TileKey& parent : wanted) {
    const ChunkGroup* group = ram.use(parent);
    if (group == nullptr) continue;
    isGpuFull = !takeIn(*group);
    if (isGpuFull) break;
    taken += static_cast<int>(group->chunks.size());
    bytes += group->bytes();
    const double ms = static_cast<double>(monotonicNs() - beginNs) * 1e-6;
    if (bytes >= options.uploadBytesPerFrame || ms >= options.uploadMsPerFrame) break;
  }
  return taken;
}

// All of the list in its order, so that what becomes resident does not depend on time.
int Pager::Impl::takeInAll() {
  const TraceScope trace("wait for terrain");
  int taken = 0;
  for (size_t i = 0; i < wanted.size(); ++i) {
    while (!lost.contains(wanted[i]) && ram.use(wanted[i]) == nullptr) {
      sendRequests(i);
      thread.waitForResult();
      takeResults();
    }
    if (lost.contains(wanted[i])) continue;
    const ChunkGroup* group = ram.use(wanted[i]);
    isGpuFull = !takeIn(*group);
    if (isGpuFull) break;
    taken += static_cast<int>(group->chunks.size());
  }
  return taken;
}

Pager::Pager(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Pager::~Pager() = default;
TerrainCache& Pager::cache() {
  return impl_->cache;
}
const DatabaseInfo& Pager::info() const {
  return impl_->info;
}

Result<std::unique_ptr<Pager>> Pager::create(const std::string& databasePath, GpuStore& gpu,
                                             const PagerOptions& options) {
  const TraceScope trace("load roots");
  Result<DatabaseReader> reader = DatabaseReader::open(databasePath);
  if (!reader) return tl::unexpected(reader.error());
  std::vector<ResidentChunk> roots;
  const auto giveUp = [&](Error error) {
    for (const ResidentChunk& root : roots) gpu.release(root.gpu);
    return tl::unexpected(std::move(error));
  };
  for (int octant = 0; octant < kOctants; ++octant) {
    const TileKey key = TileKey::octantRoot(octant);
    const Result<LoadedChunk> chunk = loadChunk(*reader, key);
    if (!chunk) return giveUp(chunk.error());
    if (!chunk->meta.hasImagery)
      return giveUp(
          {ErrorKind::badData, fmt::format("{}: {} has no imagery; bake it again", databasePath, key.name())});
    const std::optional<GpuChunk> place = gpu.upload(*chunk);
    if (!place)
      return giveUp({ErrorKind::usage, fmt::format("the GPU budget has no room for the eight roots of {}; raise "
                                                   "--cache-gpu",
                                                   databasePath)});
    roots.push_back(residentFrom(*chunk, *place));
  }
  auto impl = std::make_unique<Impl>(std::move(*reader), gpu, options);
  impl->cache.insertRoots(roots);
  return std::unique_ptr<Pager>(new Pager(std::move(impl)));
}

int Pager::exchange(const Selection& selection) {
  const TraceScope trace("exchange");
  Impl& pager = *impl_;
  pager.isEvictableListed = false;
  pager.takeResults();
  pager.listWantedGroups(selection);
  // What did not fit waits, and nothing is read, until something else has fallen out of use.
  if (pager.isGpuFull && !pager.wanted.empty()) pager.isGpuFull = !pager.canEvict();
  int taken = 0;
  if (!pager.isGpuFull) taken = pager.options.wait ? pager.takeInAll() : pager.takeInWithinBudget();
  std::erase_if(pager.wanted,
                [&](const TileKey& parent) { return !pager.cache.children(*pager.cache.find(parent)).empty(); });
  pager.sendRequests(0);
  return taken;
}

PagingCounts Pager::counts() const {
  PagingCounts counts = impl_->counts;
  counts.resident = impl_->cache.size();
  counts.ramBytes = impl_->ram.bytes() + impl_->thread.resultBytes();
  counts.gpuBytes = impl_->gpu.bytesResident();
  return counts;
}

}  // namespace eye
